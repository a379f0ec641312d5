// The largest stable stiffness and damping of a force that lags the motion by T (transport, waiting times, and half the
// time for which it is held), and the scale of the force that the user wants, within that limit.
//
// A lagging spring K is a spring with the damping -K T (Colgate & Schenkel 1997; with transport: Diolaiti et al. 2006).
// The limit is K T <= b + c B, where
//   b  damping of the lightest hand
//   B  largest rendered damping, m / (2 T): rendered damping lags, too, and is unstable on a mass m above pi/2 m / T
//   c  share of B that the passivity controller provides: 0.22. It is measured, not derived. An upper limit is known: a
//      controller that always damps could provide 1.1, because m x''(t) + B x'(t - T) + K x(t - T) = 0 is unstable for
//      K > 0.55 m / T^2 with any B. This one acts during unloading only, and after a debt. 0.22 keeps the swing of
//      every simulated hand (50 to 300 g, lags to 10 ms, 600 to 7000 N/m) within 0.1 mm: tests/accuracy/
//      closed_loop_late_test.cpp. c decreases with the encoder step, because the controller does not act within a play
//      of one step.
// B limits the sum of the damping of model and user, and that of user and controller.
//
// Thread guarantee: one thread at a time; wait-free.
#pragma once

#include <algorithm>
#include <cmath>

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
  static constexpr double kRise_s = 0.1;
  static constexpr double kFall_s = 1.0;
  static constexpr double kNone = 1e-9;
  double share_;
  double lag_s_ = 0.0;
};

// The scale that the user wants for the force of the active model, and additional damping:
//   F' = k F + d v     in contact; k: stiffness, d: damping_Ns_per_m, v: velocity inward; d v never changes the sign
//                      of a positive force
// Passivity controller and limiter come after it and apply to the scaled force.
struct ForceScale {
  static constexpr double kLeast = 0.25, kMost = 4.0;
  static constexpr double kMostDamping_Ns_per_m = 20.0;
  double stiffness = 1.0;
  double damping_Ns_per_m = 0.0;
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

// Scales the force without a step.
class ScaledForce {
 public:
  // Moves the scale towards `wanted`, which is not clamped, with a time constant of 50 ms, and returns the scaled force
  // in newtons. With the default scale the force stays bit-identical.
  double apply(double force_N, double velocity_m_per_s, bool in_contact, const ForceScale& wanted,
               double step_s) noexcept {
    const double share = std::clamp(step_s / kEasing_s, 0.0, 1.0);
    ease(now_.stiffness, wanted.stiffness, share);
    ease(now_.damping_Ns_per_m, wanted.damping_Ns_per_m, share);
    if (!in_contact || now_ == ForceScale{}) return force_N;
    const double scaled_N = now_.stiffness * force_N;
    return std::max(scaled_N + now_.damping_Ns_per_m * velocity_m_per_s, std::min(scaled_N, 0.0));
  }

  const ForceScale& now() const noexcept { return now_; }

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
