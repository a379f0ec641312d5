// The stages between the force of a model and the limiter, for a force that a hand feels: the scale within the
// stability limit, then the passivity controller. The live loop and the library (models/library) run this code.
// Thread guarantee: one thread at a time; wait-free, allocates nothing, never throws.
#pragma once

#include <algorithm>

#include "engine/live/passivity_controller.h"
#include "engine/live/stability_limit.h"

namespace palpate {

class ForceGuard {
 public:
  using Tool = PassivityController::Tool;
  struct Timing {
    double lag_s = 0.0;       // of the force behind the motion; NaN or smaller: that of a device read in the tick
    double interval_s = 0.0;  // between samples
    double step_s = 0.0;      // since the last force
    double tick_s = kHapticTick_s;
  };

  explicit ForceGuard(double encoder_step_m) noexcept : stability_(encoder_step_m), passivity_(encoder_step_m) {}

  // The force of a model of this impedance, scaled as `wanted`. `held`: by a person, so that the stability limit
  // applies.
  double scaled(double force_N, const Impedance& model, const ForceScale& wanted, bool held, const Tool& tool,
                const Timing& timing) noexcept {
    // A force that is written in a tick acts from the next tick on and is held for one.
    const double in_tick_s = 1.5 * timing.tick_s;
    stability_.update(timing.lag_s > in_tick_s ? timing.lag_s : in_tick_s, timing.step_s);
    const ForceScale unbounded = wanted.limited(StabilityLimit(), {});
    const ForceScale limited = held ? wanted.limited(stability_, model) : unbounded;
    share_ = limited.stiffness / unbounded.stiffness;
    return scaled_.apply(force_N, tool.velocity_m_per_s, tool.in_contact, limited, timing.step_s);
  }

  // After `scaled`. `written_N`: the device's last force.
  double passive(double commanded_N, const Tool& tool, const Timing& timing, double written_N) noexcept {
    const double hold_s = std::max(timing.tick_s, timing.interval_s);
    const PassivityController::Loop loop{std::max(0.0, stability_.lag_s() - 0.5 * hold_s),
                                         std::max(0.0, stability_.damping_Ns_per_m() - scaled_.now().damping_Ns_per_m),
                                         hold_s, timing.tick_s};
    return passivity_.apply(commanded_N, tool, loop, written_N, timing.step_s);
  }

  double stiffness_share() const noexcept { return share_; }  // rendered part of the wanted one; < 1: StabilityLimit
  double lag_s() const noexcept { return stability_.lag_s(); }

 private:
  StabilityLimit stability_;
  ScaledForce scaled_;
  PassivityController passivity_;
  double share_ = 1.0;
};

}  // namespace palpate
