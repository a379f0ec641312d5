// Keeps the rendered force from returning more energy than it received.
//
//   force |        loading ___/
//         |           ___/_/
//         |     _____/_/ unloading
//         |____/_/_________________ depth
//
// A press to a depth and back. The tool puts in the area below the upper path and gets back the one below the lower. A
// material returns at most what it received. A force that is held for T and late by t_d is that of an earlier depth:
// too small on the way in, too large on the way out, so that the paths cross and the loop gains energy.
//
// Why: such a force acts as negative damping -K (T / 2 + t_d) beside its stiffness K (Colgate & Schenkel 1997). Without
// enough damping in material and hand the tool swings.
//
// Observer: E, the energy that the tool has put in since contact, E += F dx. F is the force that acted during dx: the
// one that was written t_d + T before; the mean of these where samples come less often than ticks (Ryu et al. 2004).
// During loading E is stored with the depth. During unloading E at each depth must be at least the stored E at that
// depth; the deficit is the debt. (The usual condition, E >= 0, shows a gain only after all stored energy was
// returned.) Noise of one encoder step is no motion: the observer follows the position with a play (dead zone) of one
// step, so that at each turn an energy of F times the step is not observed.
//
// Controller: while the tool moves out with v < 0 and there is a debt, the force is reduced by
// min(b, debt / (v^2 T)) |v|. b is the damping limit of StabilityLimit minus the user's damping. Without a debt the
// force is unchanged. When the active model changes, the observer begins again, because E of another material is not
// comparable.
// Sources: Hannaford & Ryu (2002), IEEE Trans. Robotics & Automation 18(1); Ryu et al. (2004) for a reference that
// follows the depth.
// Thread guarantee: one thread at a time; wait-free, allocates nothing, never throws.
#pragma once

#include <array>
#include <cstddef>

#include "engine/tick/tool_sample.h"

namespace palpate {

class PassivityController {
 public:
  // `encoder_step_m`: 0 without an encoder.
  explicit PassivityController(double encoder_step_m = 0.0) noexcept : play_m_(kPlay_steps * encoder_step_m) {}

  struct Tool {
    double position_m = 0.0;  // of the sample, quantised by the encoder, inwards
    double velocity_m_per_s = 0.0;
    bool in_contact = false;
    bool model_changing = false;  // the active model is changing
    bool fresh = true;            // a sample was read in this tick
  };
  struct Loop {
    double transport_s = kHapticTick_s;  // from a sample to its force; with hold_s at most 63 ms
    double damping_Ns_per_m = 16.0;      // b
    double hold_s = kHapticTick_s;       // T, for which a force is held: one tick, or until the next sample
    double tick_s = kHapticTick_s;       // between two calls
  };

  // Once a tick, before the limiter. `written_N`: the device's force in the last tick; `step_s`: since then, 0 in the
  // first tick. Returns at most `commanded_N`, never less than 0 if that is positive; not finite if it is not finite.
  double apply(double commanded_N, const Tool& tool, const Loop& loop, double written_N, double step_s) noexcept;

  double debt_J() const noexcept { return debt_J_; }

 private:
  struct Passed {
    double depth_m = 0.0;
    double energy_J = 0.0;
  };
  static constexpr double kPlay_steps = 1.01;  // rounding must not let a step exceed the play
  static constexpr std::size_t kMostPassed = 256;
  static constexpr double kSpacing_m = 20e-6;
  static constexpr std::size_t kMostUnderWay = 64;

  void begin_at(double depth_m) noexcept;
  double arrived_N(const Tool& tool, double transport_s, double written_N, double step_s) noexcept;
  double reduced(double commanded_N, double reduction_N) noexcept;
  void pass_inwards(double depth_m, double energy_J) noexcept;
  double energy_when_passed(double depth_m) noexcept;

  double play_m_;
  // The depths passed during loading and not yet during unloading, ascending. The first is where the observer began,
  // with E = 0: the surface, or a greater depth.
  std::array<Passed, kMostPassed> passed_{};
  std::size_t count_ = 1;
  double energy_J_ = 0.0;
  double debt_J_ = 0.0;
  double depth_m_ = 0.0;                           // in the last tick, with the play
  std::array<double, kMostUnderWay> written_N_{};  // ring of the last ticks
  std::size_t ticks_ = 0;
  double arrived_N_ = 0.0;  // sum over the ticks since the last sample
  int arrivals_ = 0;
  double reduction_N_ = 0.0;  // reduction in this tick
};

}  // namespace palpate
