#include "scenes/material/layered_block.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr int kNewtonSteps = 6;
constexpr double kSolved_N = 1e-12;

}  // namespace

LayeredBlock::LayeredBlock() : spectrum_(0.02, 4.0, [](double) { return kWeight; }) {}

double LayeredBlock::held_force_N(double depth_m) const noexcept {
  const double slope = kSupport_N_per_m + 0.5 * kSupportBranch_N_per_m;
  const double inclusion_m = balance_m(depth_m, slope, 0.0, 0.0);
  return kTop.force_N(depth_m) * (1.0 + 0.5 * spectrum_.total_weight()) + slope * inclusion_m;
}

double LayeredBlock::relaxed_force_N(double depth_m) const noexcept {
  return kTop.force_N(depth_m) + kSupport_N_per_m * balance_m(depth_m, kSupport_N_per_m, 0.0, 0.0);
}

std::string LayeredBlock::relaxation_times_text() const {
  return "continuous, 0.02 s to 4 s; 0.3 s under the inclusion";
}

void LayeredBlock::prepare() noexcept {
  spectrum_.prepare(substep_s());
  const double ratio = substep_s() / kSupportTime_s;
  branch_decay_ = std::exp(-ratio);
  branch_gain_ = -std::expm1(-ratio) / ratio;
}

// The y where k_i max(0, s - g - y)^1.5 = slope y + offset, by Newton's method.
// The left side falls and the right side rises with y, and their difference is
// convex: from below the root Newton overshoots at most to where the contact is
// open, which is bounded by s - g, and from there the next step is exact or from
// below.
double LayeredBlock::balance_m(double surface_m, double slope_N_per_m, double offset_N, double guess_m) noexcept {
  const double reach_m = surface_m - kGap_m;
  const double open_m = -offset_N / slope_N_per_m;
  if (open_m >= reach_m) return open_m;
  double y_m = std::clamp(guess_m, open_m, reach_m);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double squeezed_m = std::max(0.0, reach_m - y_m);
    const double root = std::sqrt(squeezed_m);
    const double excess_N = kInclusion_N_per_m1_5 * squeezed_m * root - slope_N_per_m * y_m - offset_N;
    if (std::abs(excess_N) < kSolved_N) break;
    const double slope = 1.5 * kInclusion_N_per_m1_5 * root + slope_N_per_m;
    y_m = std::clamp(y_m + excess_N / slope, open_m, reach_m);
  }
  return y_m;
}

double LayeredBlock::inclusion_after_m(double surface_m) const noexcept {
  const double branch_N_per_m = kSupportBranch_N_per_m * branch_gain_;
  return balance_m(surface_m, kSupport_N_per_m + branch_N_per_m,
                   branch_N_ * branch_decay_ - branch_N_per_m * inclusion_m_, inclusion_m_);
}

double LayeredBlock::contact_force_N(double surface_m, double) const noexcept {
  const double elastic_N = kTop.force_N(surface_m);
  const double squeezed_m = surface_m - kGap_m - inclusion_after_m(surface_m);
  const double inclusion_N = squeezed_m > 0.0 ? kInclusion_N_per_m1_5 * squeezed_m * std::sqrt(squeezed_m) : 0.0;
  return elastic_N + spectrum_.memory_N(elastic_N - elastic_N_) + inclusion_N;
}

void LayeredBlock::settle(double surface_m, bool) noexcept {
  const double elastic_N = kTop.force_N(surface_m);
  spectrum_.settle(elastic_N - elastic_N_);
  elastic_N_ = elastic_N;
  const double inclusion_m = inclusion_after_m(surface_m);
  branch_N_ = branch_N_ * branch_decay_ + kSupportBranch_N_per_m * branch_gain_ * (inclusion_m - inclusion_m_);
  if (std::abs(branch_N_) < kNoForce_N) branch_N_ = 0.0;
  inclusion_m_ = std::abs(inclusion_m) < 1e-30 ? 0.0 : inclusion_m;
}

void LayeredBlock::forget(double surface_m) noexcept {
  spectrum_.forget();
  elastic_N_ = kTop.force_N(surface_m);
  inclusion_m_ = balance_m(surface_m, kSupport_N_per_m, 0.0, 0.0);
  branch_N_ = 0.0;
}

}  // namespace palpate
