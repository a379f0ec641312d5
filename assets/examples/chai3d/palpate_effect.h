// A CHAI3D haptic effect (3.2 or later) that renders a Palpate model on a shape, in place of cEffectSurface:
//
//   object->addEffect(new PalpateEffect(object, palpate::Model("block.json"), lag_s));
//
// The normal force is that of the model at the depth below the nearest point of the surface; there is no friction. One
// stream and one limiter for each haptic point of a tool, so that each has the memory of its own contact. Shapes only
// (cShapeBox, cShapeSphere, ...): a mesh is rendered by its proxy, without effects of this kind.
// Thread guarantee: construction is slow side; computeForce belongs to the haptics thread and allocates nothing.
#pragma once

#include <palpate/palpate.hpp>

#include <chrono>
#include <vector>

#include "chai3d.h"

class PalpateEffect : public chai3d::cGenericEffect {
 public:
  // `lag_s`: from the motion to the force, the transport of the device and half a period. `encoder_step_m`: of the
  // device at the tool; 0: that of the model's recordings. `metres_per_unit`: of the virtual world, 1 / the
  // tool's getWorkspaceScaleFactor(), because a model has one size.
  // Throws palpate::Failure: a number is not valid.
  PalpateEffect(chai3d::cGenericObject* parent, const palpate::Model& model, double lag_s, double encoder_step_m = 0.0,
                double metres_per_unit = 1.0, const palpate::Limits& limits = {})
      : cGenericEffect(parent), metres_per_unit_(metres_per_unit) {
    for (int point = 0; point < chai3d::C_EFFECT_MAX_IDN; ++point) {
      contacts_.push_back({palpate::Stream(model, encoder_step_m), palpate::Limiter(limits), begin_});
      if (!contacts_.back().limiter.set_lag(lag_s)) throw palpate::Failure("lag_s: expected a number, 0 or more");
    }
  }

  // The part of the force that stability leaves at this lag (palpate_limiter_stiffness_share).
  double stiffness_share(unsigned int point = 0) const { return contacts_.at(point).limiter.stiffness_share(); }

  // Positions and force in the frame of the object.
  bool computeForce(const chai3d::cVector3d& tool, const chai3d::cVector3d&, const unsigned int& point,
                    chai3d::cVector3d& force) override {
    force.zero();
    if (point >= contacts_.size()) return false;
    Contact& contact = contacts_[point];
    const Clock::time_point now = Clock::now();
    const double time_s = seconds(now - begin_), step_s = seconds(now - contact.before);
    contact.before = now;
    const bool inside = m_parent->m_interactionInside;
    chai3d::cVector3d outward = inside ? m_parent->m_interactionPoint - tool : tool - m_parent->m_interactionPoint;
    const double distance = outward.length();
    const double depth_m = (inside ? distance : -distance) * metres_per_unit_;
    const double force_N = contact.limiter.render(contact.stream, time_s, depth_m, step_s);
    if (distance <= 0.0) return inside;
    outward.mul(force_N / distance);
    force = outward;
    return force_N != 0.0;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

  struct Contact {
    palpate::Stream stream;
    palpate::Limiter limiter;
    Clock::time_point before;
  };

  Clock::time_point begin_ = Clock::now();
  double metres_per_unit_;
  std::vector<Contact> contacts_;
};
