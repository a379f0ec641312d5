// Scales the stiffness of the active model and adds damping, as the user wants, within the stability limit
// (StabilityLimit). Passivity controller and limiter come after it and apply to the scaled force.
//
//   F' = k F + b v     in contact; k: stiffness, b: damping_Ns_per_m, v: velocity inward; b v never changes the sign
//                      of a positive force
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

  // Clamped to the bounds above and, for a model of this impedance, to the stability limit.
  ForceScale limited(const StabilityLimit& limit, const Impedance& model) const noexcept {
    const double scale = std::min(std::clamp(stiffness, kLeast, kMost), limit.largest_scale(model));
    // Half of the rest, because the estimated velocity lags more than the position; the passivity controller uses the
    // other half.
    const double left_Ns_per_m = 0.5 * (limit.damping_Ns_per_m() - scale * model.damping_Ns_per_m);
    return {scale, std::min(std::clamp(damping_Ns_per_m, 0.0, kMostDamping_Ns_per_m), left_Ns_per_m)};
  }
};

class ScaledForce {
 public:
  // Moves towards `wanted`, which is not clamped, with a time constant of 50 ms, so that the change is not felt as a
  // kick, and returns the scaled force. With the default scale the force stays bit-identical.
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
