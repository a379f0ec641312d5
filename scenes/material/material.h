// The virtual materials: a block that is pressed along one direction, and the table of materials by name. The laws are
// in material_laws.h and share no code with the models that are fitted to them. Thread guarantee: `Block` one thread at
// a time, `step` is wait-free, allocates nothing and fits the haptic tick; the functions are pure, and `make_block`
// allocates.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <string_view>

#include "devices/virtual/simulated_devices.h"
#include "engine/base/result.h"

namespace palpate {

// The exact update of a Maxwell branch of stiffness K for a displacement ds at constant speed:
//   F <- F decay + K ds gain
struct MaxwellStep {
  MaxwellStep() = default;
  MaxwellStep(double substep_s, double relaxation_time_s) noexcept {
    const double ratio = substep_s / relaxation_time_s;
    decay = std::exp(-ratio);
    gain = -std::expm1(-ratio) / ratio;
  }
  double decay = 1.0, gain = 1.0;
};

// A block of virtual material with memory, pressed along one direction. A derived class is a material law: it
// computes the force at the end of a sub-step in which the surface moves to the depth s at constant speed, and keeps
// the state of the material. This class handles contact. The surface never pulls: when the tool retracts faster than
// the material recovers, they separate. The free surface then recovers without force on the tool until it meets the
// tool or is flat. A sub-step takes at most 0.1 ms, whatever the step of the caller, so that the force does not depend
// on the sampling rate.
// Every law is passive: from the undeformed state on, the work done on the block is never negative. Each law
// has the proof. Force is positive when it pushes the tool out.
class Block {
 public:
  virtual ~Block() = default;

  // Moves the tool within `dt_s` to `position_m`, where it has the velocity `velocity_m_per_s`. Returns the force
  // there, N, >= 0. Position and velocity follow the cubic Hermite polynomial between both ends, in sub-steps of at
  // most 0.1 ms (longer ones only when dt_s exceeds 0.1 s). Errors: an argument that is not finite, or dt_s <= 0,
  // changes nothing and returns the last force.
  double step(double position_m, double velocity_m_per_s, double dt_s) noexcept;

  // Places the tool at rest at `position_m`, and relaxes the material fully there. The force is 0 until the next step.
  void reset(double position_m = 0.0) noexcept;

  double force_N() const noexcept { return force_N_; }
  // The depth of the surface, m, >= 0, at the end of the last sub-step: in contact the depth of the tool, larger while
  // a free surface recovers.
  double surface_depth_m() const noexcept { return surface_m_; }

  // The approximate force of a short press to `depth_m` >= 0, N, with the material half relaxed; it rises with the
  // depth. The simulated hand inverts it to find the depth of a press.
  virtual double half_relaxed_force_N(double depth_m) const noexcept = 0;

 protected:
  Block() = default;
  Block(const Block&) = default;
  Block& operator=(const Block&) = default;

  double substep_s() const noexcept { return substep_s_; }

  // Smaller forces are set to 0, because denormal numbers are slow.
  static constexpr double kNoForce_N = 1e-30;

 private:
  // Called when the length of the sub-step has changed.
  virtual void prepare() noexcept {}
  // Called at the beginning of a sub-step, for all that does not depend on the next depth of the surface.
  virtual void begin_substep() noexcept {}
  // The force on the tool if the surface moves with it to `surface_m`.
  virtual double contact_force_N(double surface_m, double rate_m_per_s) const noexcept = 0;
  // The restoring force of a free surface if it moves to `surface_m`. The surface moves to the depth at which it is 0.
  virtual double free_force_N(double surface_m, double rate_m_per_s) const noexcept {
    return contact_force_N(surface_m, rate_m_per_s);
  }
  // Updates the state for a move of the surface from surface_depth_m() to `surface_m`.
  virtual void update_state(double surface_m, bool touching) noexcept = 0;
  // Sets the state to fully relaxed at `surface_m`.
  virtual void reset_state(double surface_m) noexcept = 0;

  void substep(double position_m, double velocity_m_per_s) noexcept;
  void move_surface(double surface_m, bool touching) noexcept;
  double free_surface_m(double depth_m, double depth_residual_N) const noexcept;
  double residual_N(double surface_m) const noexcept;

  double position_m_ = 0.0, velocity_m_per_s_ = 0.0, surface_m_ = 0.0, force_N_ = 0.0;
  double substep_s_ = 0.0;
};

inline constexpr double kUsualRecording_s = 41.499, kUsualForceRange_N = 10.0;

struct Material {
  std::string_view name;
  std::string_view summary;           // one line
  std::string_view relaxation_times;  // the true ones, in words
  // Returns an undeformed block with the parameters of this material.
  std::unique_ptr<Block> (*make_block)() = nullptr;
  double recording_seconds = kUsualRecording_s;                 // default length of a recording
  double force_range_N = kUsualForceRange_N;                    // default range of the force sensor
  double strongest_press_N = HandSettings{}.strongest_press_N;  // default of the hand of a recording
};

// All materials, in the order of lists.
std::span<const Material> materials() noexcept;

// Errors: unknown name; lists the known names.
Result<Material> find_material(std::string_view name);

}  // namespace palpate
