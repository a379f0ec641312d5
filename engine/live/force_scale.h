// The active model made stiffer or softer, and more damped, by whoever holds the tool.
// Bounded by what is stable (StabilityLimit). It comes before passivity and limiter: what they promise, they promise of
// this force.
//
//   F' = k F + b v     in contact; b v, v inward, never turns a push into a pull
//
// Thread guarantee: the haptics thread; wait-free.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/live/stability_limit.h"

namespace palpate {

struct ForceScale {
  static constexpr double kLeast = 0.25, kMost = 4.0;
  static constexpr double kMostDamping_Ns_per_m = 20.0;
  double stiffness = 1.0;
  double damping_Ns_per_m = 0.0;
  bool operator==(const ForceScale&) const = default;

  // Within the bounds above, and of a model of this impedance what is stable.
  ForceScale limited(const StabilityLimit& limit, const Impedance& model) const noexcept {
    const double scale = std::min(std::clamp(stiffness, kLeast, kMost), limit.largest_scale(model));
    // Half of what is left, for the velocity that it uses lags by more than the position; the passivity controller has
    // the rest.
    const double left_Ns_per_m = 0.5 * (limit.damping_Ns_per_m() - scale * model.damping_Ns_per_m);
    return {scale, std::min(std::clamp(damping_Ns_per_m, 0.0, kMostDamping_Ns_per_m), left_Ns_per_m)};
  }
};

class ScaledForce {
 public:
  // Moves towards `wanted`, which is not clamped, within a tenth of a second or two, so that it is not felt as a kick.
  // As it is by default, the force keeps its bits.
  double apply(double force_N, double velocity_m_per_s, bool in_contact, const ForceScale& wanted,
               double step_s) noexcept {
    const double share = std::clamp(step_s / kEasing_s, 0.0, 1.0);
    ease(now_.stiffness, wanted.stiffness, share);
    ease(now_.damping_Ns_per_m, wanted.damping_Ns_per_m, share);
    if (!in_contact || now_ == ForceScale{}) return force_N;
    const double scaled_N = now_.stiffness * force_N;
    return std::max(scaled_N + now_.damping_Ns_per_m * velocity_m_per_s, std::min(scaled_N, 0.0));
  }

 private:
  static constexpr double kEasing_s = 0.05;
  static constexpr double kArrived = 1e-3;
  static void ease(double& value, double wanted, double share) noexcept {
    value += share * (wanted - value);
    if (std::abs(wanted - value) < kArrived) value = wanted;
  }
  ForceScale now_;

 public:
  const ForceScale& now() const noexcept { return now_; }
};

}  // namespace palpate
