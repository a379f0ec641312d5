// The largest stable stiffness and damping of a force that lags the motion by T: transport, waiting times, and half the
// time for which it is held.
//
// A lagging spring K is a spring with the damping -K T (Colgate & Schenkel 1997; with transport: Diolaiti et al. 2006).
// The limit is K T <= b + c B, where
//   b  damping of the lightest hand
//   B  largest rendered damping, m / (2 T): rendered damping lags, too, and is unstable on a mass m above pi/2 m / T
//   c  share of B that the passivity controller provides. It is below a quarter, because the controller damps only
//      during unloading, and m x''(t) + B x'(t - T) + K x(t - T) = 0 is unstable for K > 0.55 m / T^2 with any B. It
//      decreases with the encoder step, because the controller does not act within a play of one step.
// B limits the sum of the damping of the model, of the user and of the controller. Verified by
// tests/accuracy/closed_loop_late_test.cpp.
//
// Thread guarantee: one thread at a time; wait-free.
#pragma once

#include <algorithm>

namespace palpate {

// The response to a small cycle about a depth: F' = stiffness x' + damping v'.
struct Impedance {
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
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

  // Follows the current lag `lag_s` with a time constant of 0.1 s where it grows and 1 s where it falls: an increase
  // of stiffness during a press adds energy.
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
  static constexpr double kRise_s = 0.1;
  static constexpr double kFall_s = 1.0;
  static constexpr double kNone = 1e-9;
  double share_;
  double lag_s_ = 0.0;
};

}  // namespace palpate
