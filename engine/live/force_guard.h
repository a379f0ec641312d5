// The stages between the forces of the models and the limiter, for a force that a hand feels: the fade between models,
// the scale within the stability limit, then the passivity controller. The live loop runs all of them, the library
// (models/library) those of ForceGuard.
//
// Stability limit: K T <= b + c B, B = m / (2 T), for a spring K whose force lags the motion by T (LoopDelay). It acts
// with the damping -K T (Colgate & Schenkel 1997; with transport: Diolaiti et al. 2006). b is the damping of a hand, B
// the largest damping that may be rendered: it lags, too, and is unstable on a mass m above pi/2 m / T. c is the share
// of B that the passivity controller provides. b and c are those of the simulation in
// tests/accuracy/closed_loop_link_test.cpp: over rates, groups, delays and jitter, the lightest hand (50 g, 2.2 N s/m)
// keeps still within 0.35 mm up to K T = 2.1 N s/m + 0.46 B with an encoder of 10 um; the limit is 0.85 of that. The
// controller has a play of one step, so that c goes to 0 at steps of 50 um. The test does not cover coarser encoders.
// B limits the sum of the damping of model and user, and that of user and controller. devices/README.md has what it
// achieves behind simulated links.
//
// Passivity controller (Hannaford & Ryu 2002; Ryu et al. 2004 for a reference that follows the depth). A late force is
// too small on the way in and too large on the way out, so that the loop gains energy. Observer: E += F dx, the energy
// put in since contact, F the force that acted during dx. During loading E is stored with the depth; during unloading
// the deficit of E from the value stored at that depth is the debt. (The usual condition, E >= 0, shows a gain only
// after all stored energy was returned.) The observer follows the position with a play (dead zone) of one encoder step,
// so that noise is no motion. While the tool moves out with v < 0 and there is a debt, the force is reduced by
// min(b, debt / (v^2 T)) |v|, b the rest of B, T the time for which the force is held. When the active model changes,
// the observer begins again, because E of another material is not comparable.
// Thread guarantee: one thread at a time; wait-free, allocates nothing, never throws.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/live/device.h"
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

// The delay T of the loop: the mean age of the forces that acted within 1/16 s, the largest such mean of the last
// second. Thus it includes transport, waits, and half the time for which a force is held, however samples and commands
// are grouped. The largest counts, because a group that is late from time to time is enough to start an oscillation; of
// means, because the extremes of a link with jitter differ from second to second, and the force would with them.
class LoopDelay {
 public:
  static constexpr std::size_t kParts = 17;
  static constexpr double kPart_s = 1.0 / static_cast<double>(kParts - 1);

  // `weight`: how long it acted, relative to the others. `time_s` does not decrease. O(1).
  void add(const ForceAge& age, double weight, double time_s) noexcept {
    move_to(time_s);
    Ages& part = parts_[part_ % kParts];
    part.sum_s += weight * age.middle_s();
    part.weights += weight;
  }
  void move_to(double time_s) noexcept {
    const auto part = static_cast<std::size_t>(std::max(0.0, time_s) * static_cast<double>(kParts - 1));
    for (std::size_t i = std::max(part_ + 1, part < kParts ? 0 : part - kParts + 1); i <= part; ++i)
      parts_[i % kParts] = {};
    part_ = std::max(part_, part);
  }
  // 0: nothing was added in the last second.
  double delay_s() const noexcept {
    double delay_s = 0.0;
    // The present part is not complete.
    for (std::size_t i = 1; i < kParts; ++i) delay_s = std::max(delay_s, parts_[(part_ + i) % kParts].mean_s());
    return delay_s > 0.0 ? delay_s : parts_[part_ % kParts].mean_s();
  }

 private:
  struct Ages {
    double sum_s = 0.0, weights = 0.0;
    double mean_s() const noexcept { return weights > 0.0 ? sum_s / weights : 0.0; }
  };

  std::array<Ages, kParts> parts_{};
  std::size_t part_ = 0;
};

class StabilityLimit {
 public:
  static constexpr double kLightestHand_kg = 0.05;      // m, a finger on which a tool rests
  static constexpr double kHandDamping_Ns_per_m = 1.8;  // b; relaxed fingers have more (Hajian & Howe 1997)
  static constexpr double kShareOfDamping = 0.38;       // c
  static constexpr double kFine_m = 10e-6, kCoarse_m = 50e-6;
  explicit StabilityLimit(double encoder_step_m = 0.0) noexcept
      : share_(kShareOfDamping * std::clamp((kCoarse_m - encoder_step_m) / (kCoarse_m - kFine_m), 0.0, 1.0)) {}

  // Follows the current delay with a time constant of 0.1 s where it grows and 2 s where it falls, because an
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
  static constexpr double kRise_s = 0.1, kFall_s = 2.0, kNone = 1e-9;
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
  struct Timing {
    double step_s = 0.0;            // since the last call, 0 in the first one
    double tick_s = kHapticTick_s;  // the usual step
    double delay_s = 0.0;           // the least delay of the loop, for what it cannot measure itself
  };

  // Once a tick, before the limiter. `timing.delay_s`: the age of the force that acted, at most 63 ticks.
  // `damping_Ns_per_m`: the most that it may render. `written_N`: the device's force in the last tick. Returns
  // at most `commanded_N`, never less than 0 if that is positive; not finite if it is not finite.
  double apply(double commanded_N, const Tool& tool, const Timing& timing, double damping_Ns_per_m,
               double written_N) noexcept;

 private:
  struct Passed {
    double depth_m = 0.0, energy_J = 0.0;
  };
  static constexpr double kPlay_steps = 1.01;  // rounding must not let a step exceed the play
  static constexpr std::size_t kMostPassed = 256;
  static constexpr double kSpacing_m = 20e-6;
  static constexpr std::size_t kMostUnderWay = 64;

  void begin_at(double depth_m) noexcept;
  double arrived_N(const Tool& tool, const Timing& timing, double written_N) noexcept;
  double reduced(double commanded_N, double reduction_N) noexcept;
  void pass_inwards(double depth_m, double energy_J) noexcept;
  double energy_when_passed(double depth_m) noexcept;

  double play_m_;
  // The depths passed during loading and not yet during unloading, ascending. The first is where the observer began,
  // with E = 0: the surface, or a greater depth.
  std::array<Passed, kMostPassed> passed_{};
  std::size_t count_ = 1;
  double energy_J_ = 0.0, debt_J_ = 0.0;
  double depth_m_ = 0.0;  // in the last tick, with the play
  struct Written {
    double time_s = 0.0, force_N = 0.0;
  };
  std::array<Written, kMostUnderWay> written_{};  // ring of the last ticks
  std::size_t ticks_ = 0;
  double time_s_ = 0.0;
  double arrived_N_ = 0.0;  // sum over the ticks since the last sample
  int arrivals_ = 0;
  double hold_s_ = 0.0, since_sample_s_ = 0.0;  // between the last two samples, and since the last one
  double reduction_N_ = 0.0;                    // reduction in this tick
};

// One thread at a time; wait-free.
class ForceGuard {
 public:
  using Tool = PassivityController::Tool;
  using Timing = PassivityController::Timing;

  explicit ForceGuard(double encoder_step_m) noexcept : stability_(encoder_step_m), passivity_(encoder_step_m) {}

  // For every sample, before `scaled` of the same tick.
  void acted(const ForceAge& age, double tick_s = kHapticTick_s) noexcept {
    // A longer pause is no delay of the loop.
    const double since_s = std::min(time_s_ - std::exchange(sampled_s_, time_s_), LoopDelay::kPart_s);
    // A force that is written in a tick acts from the next tick on at the latest, until the next sample is used.
    const bool known = age.largest_s >= 0.0;
    // A force with an unknown delay can make a hand oscillate.
    waits_ = waits_ && !known;
    if (!known || !(age.largest_s > 0.0 || since_s > 0.0)) return;
    // A device that reports ages does so for samples that are as far apart as it says. Without them, of samples that
    // are read at once the last one's force acts until the next.
    const bool reported = age.largest_s > 0.0;
    acted_ = reported ? age : ForceAge{tick_s, since_s + tick_s};
    delay_.add(acted_, reported ? 1.0 : since_s, time_s_);
  }

  // The force of a model of this impedance, scaled as `wanted`; the scale moves there with a time constant of 50 ms.
  // `held`: by a person, so that the stability limit applies, and there is no force before the first age is known. With
  // the default scale the force stays bit-identical.
  double scaled(double force_N, const Impedance& model, const ForceScale& wanted, bool held, const Tool& tool,
                const Timing& timing) noexcept {
    time_s_ += timing.step_s;
    if (held && waits_) {
      scale_ = {0.0, 0.0};
      share_ = 0.0;
      return 0.0;
    }
    delay_.move_to(time_s_);
    stability_.update(std::max({delay_.delay_s(), 1.5 * timing.tick_s, timing.delay_s}), timing.step_s);
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
    const double left_Ns_per_m = std::max(0.0, stability_.damping_Ns_per_m() - scale_.damping_Ns_per_m);
    const Timing known{timing.step_s, timing.tick_s, std::max(acted_.middle_s(), timing.delay_s + 0.5 * timing.tick_s)};
    return passivity_.apply(commanded_N, tool, known, left_Ns_per_m, written_N);
  }

  double stiffness_share() const noexcept { return share_; }  // rendered part of the wanted one; < 1: StabilityLimit
  double delay_s() const noexcept { return stability_.lag_s(); }

 private:
  static constexpr double kEasing_s = 0.05, kArrived = 1e-3;
  static void ease(double& value, double wanted, double step_s) noexcept {
    value += std::clamp(step_s / kEasing_s, 0.0, 1.0) * (wanted - value);
    if (std::abs(wanted - value) < kArrived) value = wanted;
  }

  ForceAge acted_;  // of the force that acted before the last sample
  LoopDelay delay_;
  StabilityLimit stability_;
  ForceScale scale_;  // of the present force
  PassivityController passivity_;
  bool waits_ = true;  // for the first age
  double share_ = 1.0, time_s_ = 0.0;
  double sampled_s_ = std::numeric_limits<double>::infinity();  // time of the last sample; none
};

}  // namespace palpate
