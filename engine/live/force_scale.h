// The active model made stiffer or softer, and more damped, by whoever holds the tool.
// It comes before passivity and limiter: what they promise, they promise of this force.
//
//   F' = k F + b v     in contact; b v, v inward, never turns a push into a pull
//
// Thread guarantee: the haptics thread; wait-free.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

struct ForceScale {
  static constexpr double kLeast = 0.25, kMost = 4.0;
  static constexpr double kMostDamping_Ns_per_m = 20.0;
  double stiffness = 1.0;
  double damping_Ns_per_m = 0.0;
  bool operator==(const ForceScale&) const = default;
};

class ScaledForce {
 public:
  // Moves towards `wanted` within a tenth of a second or two, so that it is not felt as a kick.
  // As it is by default, the force keeps its bits.
  double apply(double force_N, double velocity_m_per_s, bool in_contact, const ForceScale& wanted,
               double step_s) noexcept {
    const double share = std::clamp(step_s / kEasing_s, 0.0, 1.0);
    ease(now_.stiffness, std::clamp(wanted.stiffness, ForceScale::kLeast, ForceScale::kMost), share);
    ease(now_.damping_Ns_per_m, std::clamp(wanted.damping_Ns_per_m, 0.0, ForceScale::kMostDamping_Ns_per_m), share);
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
};

}  // namespace palpate
