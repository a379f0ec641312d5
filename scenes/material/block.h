// A block of virtual material with its memory, pressed along one direction. A law says what force a surface
// at depth s meets at the end of a short sub-step, the surface having moved there evenly, and remembers
// where it went. The rest is here: the surface never pulls. When the tool retracts faster than the material
// follows, they separate, and the free surface comes back by itself, without a force, until it meets the
// tool or is flat again; the memory goes on meanwhile. Sub-steps are 0.1 ms or less whatever the caller's
// step, so that a motion gives the same force at every sampling rate.
// Every law is passive: from its untouched state on, the work that was put in is never negative. Each
// header says why. Force is positive when it pushes the tool out.
// Thread guarantee: one thread at a time; `step` is wait-free, allocates nothing and fits the haptic tick.
#pragma once

#include <cmath>

namespace palpate {

// A Maxwell branch over one sub-step in which its spring is stretched evenly: exact,
//   F <- F decay + K ds gain
struct MaxwellStep {
  MaxwellStep() = default;
  MaxwellStep(double substep_s, double relaxation_time_s) noexcept {
    const double ratio = substep_s / relaxation_time_s;
    decay = std::exp(-ratio);
    gain = -std::expm1(-ratio) / ratio;
  }
  double decay = 1.0;
  double gain = 1.0;
};

class Block {
 public:
  virtual ~Block() = default;

  // Moves the tool to `position_m`, where it has `velocity_m_per_s`, `dt_s` later; returns the force then,
  // N, >= 0. In between position and velocity follow the cubic through both ends, in sub-steps of 0.1 ms or
  // less (longer ones only when dt_s exceeds 0.1 s). Errors: an argument that is not finite, or dt_s <= 0,
  // changes nothing and returns the last force.
  double step(double position_m, double velocity_m_per_s, double dt_s) noexcept;

  // Puts the tool at `position_m` at rest with all memory gone.
  void reset(double position_m = 0.0) noexcept;

  double force_N() const noexcept { return force_N_; }
  // The tool's depth in contact, more when the tool has left a surface that still comes back.
  double surface_depth_m() const noexcept { return surface_m_; }

  // What it holds when pressed to `depth_m` for a moment, half relaxed; rises with the depth. A hand aims by it.
  virtual double held_force_N(double depth_m) const noexcept = 0;
  // What it holds at `depth_m` when all has relaxed.
  virtual double relaxed_force_N(double depth_m) const noexcept = 0;

 protected:
  Block() = default;
  Block(const Block&) = default;
  Block& operator=(const Block&) = default;

  // Of the law, where the surface was at the end of the last sub-step.
  double last_surface_m() const noexcept { return surface_m_; }
  double substep_s() const noexcept { return substep_s_; }

  // Far below any sensor; keeps a block that rests in free air from computing with denormal numbers.
  static constexpr double kNoForce_N = 1e-30;

 private:
  // The sub-step's length has changed.
  virtual void prepare() noexcept {}
  // A sub-step begins: what does not depend on where the surface goes.
  virtual void begin_substep() noexcept {}
  // The force on the tool when the surface goes to `surface_m` with it.
  virtual double contact_force_N(double surface_m, double rate_m_per_s) const noexcept = 0;
  // The force that drives the surface back when no tool is there.
  virtual double free_force_N(double surface_m, double rate_m_per_s) const noexcept {
    return contact_force_N(surface_m, rate_m_per_s);
  }
  // The surface has gone to `surface_m`; last_surface_m() is where it was.
  virtual void settle(double surface_m, bool touching) noexcept = 0;
  // All memory gone, at rest at `surface_m`.
  virtual void forget(double surface_m) noexcept = 0;

  void substep(double position_m, double velocity_m_per_s) noexcept;
  void move_surface(double surface_m, bool touching) noexcept;
  double free_surface_m(double depth_m, double depth_residual_N) const noexcept;
  double residual_N(double surface_m) const noexcept;

  double position_m_ = 0.0;
  double velocity_m_per_s_ = 0.0;
  double surface_m_ = 0.0;
  double force_N_ = 0.0;
  double substep_s_ = 0.0;
};

}  // namespace palpate
