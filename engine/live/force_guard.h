// The stages between the forces of the models and the limiter, for a force that a hand feels: the fade between models,
// the scale within the stability limit, then the passivity controller. The live loop runs all of them, the library
// (models/library) those of ForceGuard.
//
// Stability limit. A force that lags the motion by T (transport, waiting times, half the time for which it is held) is
// a spring K with the damping -K T (Colgate & Schenkel 1997; with transport: Diolaiti et al. 2006). K T <= b + c B,
// where
//   b  damping of the lightest hand
//   B  largest rendered damping, m / (2 T): it lags, too, and is unstable on a mass m above pi/2 m / T
//   c  share of B that the passivity controller provides, 0.22: measured. Every simulated hand (50 to 300 g, lags to
//      10 ms, 600 to 7000 N/m) swings by at most 0.12 mm with encoder steps to 10 um, and by 0.35 mm with 30 um
//      (tests/accuracy/closed_loop_late_test.cpp). A controller that always damps could provide 1.1, because
//      m x''(t) + B x'(t - T) + K x(t - T) = 0 is unstable for K > 0.55 m / T^2 with any B. c decreases with the
//      encoder step, because the controller has a play of one step.
// B limits the sum of the damping of model and user, and that of user and controller.
//
// Passivity controller (Hannaford & Ryu 2002; Ryu et al. 2004 for a reference that follows the depth): keeps the force
// from returning more energy than it received.
//
//   force |        loading ___/
//         |           ___/_/ unloading
//         |     _____/_/
//         |____/_/_________ depth
//
// In a press and back the tool puts in the area below the upper path and gets back the one below the lower. A late
// force is too small on the way in and too large on the way out, so that the paths cross and the loop gains energy.
//
// Observer: E += F dx, the energy put in since contact, F the force that acted during dx. During loading E is stored
// with the depth; during unloading the deficit of E from the value stored at that depth is the debt. (The usual
// condition, E >= 0, shows a gain only after all stored energy was returned.) The observer follows the position with a
// play (dead zone) of one encoder step, so that noise is no motion. While the tool moves out with v < 0 and there is a
// debt, the force is reduced by min(b, debt / (v^2 T)) |v|, b the rest of the damping limit. When the active model
// changes, the observer begins again, because E of another material is not comparable.
// Thread guarantee: one thread at a time; wait-free, allocates nothing, never throws.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// Selects the model whose force is rendered, and fades from one to the next: F = sum_i w_i F_i, sum_i w_i = 1, moves to
// the selected model s by w <- w + a (e_s - w), so F <- F + a (F_s - F). Each tick takes the largest a <= 1 for which
// the step stays below a tenth of a JND, that of the smaller of |F| and |F_s|, per millisecond: a switch changes the
// force by at most one JND in 10 ms, and at once in air. Changes of the models' own forces are not limited.
class ForceMixer {
 public:
  // The force, N, of every model of a set; the last element is that of the model selected in the previous set.
  static constexpr std::size_t kOutgoing = kMaxModels;
  using Forces = std::array<double, kMaxModels + 1>;

  explicit ForceMixer(const JndLine& jnd) noexcept : jnd_(jnd) { weights_[0] = 1.0; }

  // Selects at once, without a fade: for the start, and kOutgoing for the fade to a new set.
  void jump_to(std::size_t selected) noexcept {
    weights_.fill(0.0);
    weights_[selected] = 1.0;
  }

  // Moves the mixture towards `selected` for `step_s`, clamped to 0 to 10 ms, and returns it in newtons.
  double mix(const Forces& forces_N, std::size_t selected, double step_s) noexcept {
    // After the fade the force has the bits of the model.
    if (settled_on(selected)) return forces_N[selected];
    const double force_N = current(forces_N), difference_N = forces_N[selected] - force_N;
    const double step = step_s > 0.0 ? std::min(step_s, kJndTime_s) : 0.0;
    const double jnd_N = jnd_.at(std::min(std::abs(force_N), std::abs(forces_N[selected])));
    const double most_N = kShareOfJnd * jnd_N * step / kJndTime_s;
    if (!(std::abs(difference_N) > most_N)) {
      jump_to(selected);
      return forces_N[selected];
    }
    const double share = most_N / std::abs(difference_N);
    for (double& weight : weights_) weight *= 1.0 - share;
    weights_[selected] += share;
    return force_N + share * difference_N;
  }

  // The current mixture.
  double current(const Forces& forces_N) const noexcept {
    double force_N = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] != 0.0) force_N += weights_[i] * forces_N[i];
    return force_N;
  }

  bool settled_on(std::size_t index) const noexcept { return weights_[index] == 1.0; }

 private:
  static constexpr double kJndTime_s = 0.01;
  // A rising force increases its own JND by up to 3 % within 10 ms. This share of the JND compensates for that and for
  // rounding.
  static constexpr double kShareOfJnd = 0.95;

  JndLine jnd_;
  Forces weights_{};
};

// The response to a small cycle about a depth: F' = stiffness x' + damping v'.
struct Impedance {
  double stiffness_N_per_m = 0.0, damping_Ns_per_m = 0.0;
};

class StabilityLimit {
 public:
  static constexpr double kLightestHand_kg = 0.05;  // a finger on which a tool rests
  // A third of critical damping on 100 N/m; relaxed fingers have half and more (Hajian & Howe 1997).
  static constexpr double kHandDamping_Ns_per_m = 1.5;
  static constexpr double kShareOfDamping = 0.22;  // c with a fine encoder
  static constexpr double kCoarse_m = 30e-6;       // encoder step with c = 0: a third of the permitted swing, 0.1 mm

  explicit StabilityLimit(double encoder_step_m = 0.0) noexcept
      : share_(kShareOfDamping * std::max(0.0, 1.0 - encoder_step_m / kCoarse_m)) {}

  // Follows the current lag `lag_s` with a time constant of 0.1 s where it grows and 1 s where it falls, because an
  // increase of stiffness during a press adds energy. The first call takes it at once; before it nothing is limited.
  void update(double lag_s, double step_s) noexcept {
    const double time_s = lag_s > lag_s_ ? kRise_s : kFall_s;
    lag_s_ = lag_s_ > 0.0 ? lag_s_ + std::clamp(step_s / time_s, 0.0, 1.0) * (lag_s - lag_s_) : lag_s;
  }

  double lag_s() const noexcept { return lag_s_; }
  double damping_Ns_per_m() const noexcept { return 0.5 * kLightestHand_kg / lag_s_; }
  double stiffness_N_per_m() const noexcept { return (kHandDamping_Ns_per_m + share_ * damping_Ns_per_m()) / lag_s_; }
  // The largest stable factor of a force with this impedance.
  double largest_scale(const Impedance& of) const noexcept {
    return std::min(stiffness_N_per_m() / std::max(of.stiffness_N_per_m, kNone),
                    damping_Ns_per_m() / std::max(of.damping_Ns_per_m, kNone));
  }

 private:
  static constexpr double kRise_s = 0.1, kFall_s = 1.0, kNone = 1e-9;
  double share_, lag_s_ = 0.0;
};

// The scale that the user wants for the force of the active model, and additional damping:
//   F' = k F + d v     in contact; k: stiffness, d: damping_Ns_per_m, v: velocity inward; d v never changes the sign
//                      of a positive force
// Passivity controller and limiter come after it and apply to the scaled force.
struct ForceScale {
  static constexpr double kLeast = 0.25, kMost = 4.0, kMostDamping_Ns_per_m = 20.0;
  double stiffness = 1.0, damping_Ns_per_m = 0.0;
  bool operator==(const ForceScale&) const = default;

  // Clamped to the bounds above and, for a model of this impedance, to the stability limit.
  ForceScale limited(const StabilityLimit& limit, const Impedance& model) const noexcept {
    const double scale = std::min(std::clamp(stiffness, kLeast, kMost), limit.largest_scale(model));
    // Half of the rest, because the estimated velocity lags more than the position; the passivity controller may use
    // what the user does not.
    const double left_Ns_per_m = 0.5 * (limit.damping_Ns_per_m() - scale * model.damping_Ns_per_m);
    return {scale, std::min(std::clamp(damping_Ns_per_m, 0.0, kMostDamping_Ns_per_m), left_Ns_per_m)};
  }
};

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
    double depth_m = 0.0, energy_J = 0.0;
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
  double energy_J_ = 0.0, debt_J_ = 0.0;
  double depth_m_ = 0.0;                           // in the last tick, with the play
  std::array<double, kMostUnderWay> written_N_{};  // ring of the last ticks
  std::size_t ticks_ = 0;
  double arrived_N_ = 0.0;  // sum over the ticks since the last sample
  int arrivals_ = 0;
  double reduction_N_ = 0.0;  // reduction in this tick
};

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

  // The force of a model of this impedance, scaled as `wanted`; the scale moves there with a time constant of 50 ms.
  // `held`: by a person, so that the stability limit applies. With the default scale the force stays bit-identical.
  double scaled(double force_N, const Impedance& model, const ForceScale& wanted, bool held, const Tool& tool,
                const Timing& timing) noexcept {
    // A force that is written in a tick acts from the next tick on and is held for one.
    const double in_tick_s = 1.5 * timing.tick_s;
    stability_.update(timing.lag_s > in_tick_s ? timing.lag_s : in_tick_s, timing.step_s);
    const ForceScale unbounded = wanted.limited(StabilityLimit(), {});
    const ForceScale limited = held ? wanted.limited(stability_, model) : unbounded;
    share_ = limited.stiffness / unbounded.stiffness;
    ease(scale_.stiffness, limited.stiffness, timing.step_s);
    ease(scale_.damping_Ns_per_m, limited.damping_Ns_per_m, timing.step_s);
    if (!tool.in_contact || scale_ == ForceScale{}) return force_N;
    const double scaled_N = scale_.stiffness * force_N;
    return std::max(scaled_N + scale_.damping_Ns_per_m * tool.velocity_m_per_s, std::min(scaled_N, 0.0));
  }

  // After `scaled`. `written_N`: the device's last force.
  double passive(double commanded_N, const Tool& tool, const Timing& timing, double written_N) noexcept {
    const double hold_s = std::max(timing.tick_s, timing.interval_s);
    const PassivityController::Loop loop{std::max(0.0, stability_.lag_s() - 0.5 * hold_s),
                                         std::max(0.0, stability_.damping_Ns_per_m() - scale_.damping_Ns_per_m), hold_s,
                                         timing.tick_s};
    return passivity_.apply(commanded_N, tool, loop, written_N, timing.step_s);
  }

  double stiffness_share() const noexcept { return share_; }  // rendered part of the wanted one; < 1: StabilityLimit
  double lag_s() const noexcept { return stability_.lag_s(); }

 private:
  static constexpr double kEasing_s = 0.05, kArrived = 1e-3;
  static void ease(double& value, double wanted, double step_s) noexcept {
    value += std::clamp(step_s / kEasing_s, 0.0, 1.0) * (wanted - value);
    if (std::abs(wanted - value) < kArrived) value = wanted;
  }

  StabilityLimit stability_;
  ForceScale scale_;  // of the present force
  PassivityController passivity_;
  double share_ = 1.0;
};

}  // namespace palpate
