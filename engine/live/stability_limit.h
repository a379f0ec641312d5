// How stiff and how damped a force may be that lags the motion by t: transport, waits, and half the time for which it
// is held.
//
// A spring K acts as a spring beside the damping -K t (Colgate & Schenkel 1997; with transport: Diolaiti et al. 2006),
// so that K t <= b + c B, where
//   b  damping of the lightest hand
//   B  the most damping that may be rendered, m / (2 t): it lags as well, and on a mass m it is unstable from
//      pi/2 m / t on
//   c  what of it the passivity controller brings: half, for it damps on the way out only, and of that less than half,
//   for
//      K beyond 0.55 m / t^2 is unstable whatever the damping (the largest K of m x'' + B x'(t - t) + K x(t - t) = 0);
//      less with a coarse encoder, in whose play the controller sees nothing
// B bounds the sum of what is viscous in a model, of what the user adds and of the controller's damping. Checked by
// tests/accuracy/closed_loop_late_test.cpp.
//
// Thread guarantee: one thread at a time; wait-free.
#pragma once

#include <algorithm>

namespace palpate {

// Of a small cycle about a depth: F' = stiffness x' + damping v'.
struct Impedance {
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
};

class StabilityLimit {
 public:
  static constexpr double kLightestHand_kg = 0.05;  // a finger that a tool rests on
  // A third of critical on 100 N/m; relaxed fingers have half and more (Hajian & Howe 1997).
  static constexpr double kHandDamping_Ns_per_m = 1.5;
  static constexpr double kShareOfDamping = 0.22;  // c of a fine encoder
  static constexpr double kCoarse_m = 30e-6;       // a step of a third of the 0.1 mm that nothing may swing by: c = 0

  explicit StabilityLimit(double encoder_step_m = 0.0) noexcept
      : share_(kShareOfDamping * std::max(0.0, 1.0 - encoder_step_m / kCoarse_m)) {}

  // `late_s`: now. Followed within 0.1 s where it grows and within 1 s where it falls: stiffness that comes back
  // while a hand presses gives energy.
  void update(double late_s, double step_s) noexcept {
    const double time_s = late_s > late_s_ ? kRise_s : kFall_s;
    late_s_ = late_s_ > 0.0 ? late_s_ + std::clamp(step_s / time_s, 0.0, 1.0) * (late_s - late_s_) : late_s;
  }

  double late_s() const noexcept { return late_s_; }
  double damping_Ns_per_m() const noexcept { return 0.5 * kLightestHand_kg / late_s_; }
  double stiffness_N_per_m() const noexcept { return (kHandDamping_Ns_per_m + share_ * damping_Ns_per_m()) / late_s_; }
  // The largest factor at which a force of this impedance is stable.
  double largest_scale(const Impedance& of) const noexcept {
    return std::min(stiffness_N_per_m() / std::max(of.stiffness_N_per_m, kNone),
                    damping_Ns_per_m() / std::max(of.damping_Ns_per_m, kNone));
  }

 private:
  static constexpr double kRise_s = 0.1;
  static constexpr double kFall_s = 1.0;
  static constexpr double kNone = 1e-9;
  double share_;
  double late_s_ = 0.0;
};

}  // namespace palpate
