#include "scenes/material/button_block.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using B = ButtonBlock;

double leg_length_m(double surface_m) { return std::hypot(B::kHalfSpan_m, B::kRise_m - surface_m); }
// Written so that nothing cancels, and a flat surface has exactly 0.
double shortened_m(double surface_m) {
  return surface_m * (2.0 * B::kRise_m - surface_m) / (leg_length_m(0.0) + leg_length_m(surface_m));
}

// What a force along each leg, the skirt and the floor are together.
double dome_N(double surface_m, double leg_N, double rate_m_per_s) {
  const double beyond_m = std::max(0.0, surface_m - B::kFloor_m);
  return 2.0 * leg_N * (B::kRise_m - surface_m) / leg_length_m(surface_m) + B::kSkirt_N_per_m * surface_m +
         B::kSkirt_Ns_per_m * rate_m_per_s + B::kFloor_N_per_m1_5 * beyond_m * std::sqrt(beyond_m);
}

// Rises with the depth, over the valley as well.
double rising_N(double depth_m, double leg_N_per_m) {
  const auto at_rest_N = [&](double s) { return dome_N(s, leg_N_per_m * shortened_m(s), 0.0); };
  constexpr double kStep_m = 2e-5;
  constexpr double kLeast_N_per_m = 1.0;
  double peak_m = 0.0;  // the first
  while (peak_m < B::kRise_m && at_rest_N(peak_m + kStep_m) > at_rest_N(peak_m)) peak_m += kStep_m;
  if (depth_m <= peak_m) return at_rest_N(depth_m);
  return std::max(at_rest_N(peak_m) + kLeast_N_per_m * (depth_m - peak_m),
                  depth_m < B::kRise_m ? 0.0 : at_rest_N(depth_m));
}

}  // namespace

double ButtonBlock::held_force_N(double depth_m) const noexcept {
  return rising_N(depth_m, kLeg_N_per_m + 0.5 * kLegBranch_N_per_m);
}

double ButtonBlock::relaxed_force_N(double depth_m) const noexcept { return rising_N(depth_m, kLeg_N_per_m); }

void ButtonBlock::prepare() noexcept {
  const double ratio = substep_s() / kLegTime_s;
  branch_decay_ = std::exp(-ratio);
  branch_gain_ = -std::expm1(-ratio) / ratio;
}

ButtonBlock::Leg ButtonBlock::leg_at(double surface_m) const noexcept {
  Leg leg;
  leg.shortened_m = shortened_m(surface_m);
  const double change_m = leg.shortened_m - leg_.shortened_m;
  leg.branch_N = leg_.branch_N * branch_decay_ + kLegBranch_N_per_m * change_m * branch_gain_;
  const double limit_N = kFriction * kLeg_N_per_m * std::max(0.0, leg.shortened_m);
  leg.friction_N = std::clamp(leg_.friction_N + kPresliding_N_per_m * change_m, -limit_N, limit_N);
  return leg;
}

double ButtonBlock::contact_force_N(double surface_m, double rate_m_per_s) const noexcept {
  const Leg leg = leg_at(surface_m);
  return dome_N(surface_m, kLeg_N_per_m * leg.shortened_m + leg.branch_N + leg.friction_N, rate_m_per_s);
}

void ButtonBlock::settle(double surface_m, bool) noexcept {
  leg_ = leg_at(surface_m);
  if (std::abs(leg_.branch_N) < kNoForce_N) leg_.branch_N = 0.0;
}

void ButtonBlock::forget(double surface_m) noexcept { leg_ = {shortened_m(surface_m), 0.0, 0.0}; }

}  // namespace palpate
