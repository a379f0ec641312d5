#include "scenes/live/dent.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// How much of the remembered depth a free surface still shows.
constexpr double kShown = 0.35;
constexpr double kFading_s = 0.3;

}  // namespace

Dent::Dent(const std::vector<FeatureSpec>& features) {
  for (const FeatureSpec& feature : features) {
    if (feature.relaxation_time_s > 0.0) branches_.push_back({feature.relaxation_time_s, 0.0});
  }
}

void Dent::step(double depth_m, double error_over_jnd, double step_s) {
  double sum_m = 0.0;
  for (Branch& branch : branches_) {
    branch.depth_m = depth_m + (branch.depth_m - depth_m) * std::exp(-step_s / branch.relaxation_time_s);
    sum_m += branch.depth_m;
  }
  const double mean_m = branches_.empty() ? 0.0 : sum_m / static_cast<double>(branches_.size());
  dent_m_ = std::max(depth_m, kShown * mean_m);
  error_over_jnd_ = std::max(error_over_jnd, error_over_jnd_ * std::exp(-step_s / kFading_s));
}

}  // namespace palpate
