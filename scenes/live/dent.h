// The depth and the error colour of the dent that is drawn for one model. While the model pushes the tool, its surface
// is at the tool, so the dent has the tool's depth d. When the force ends, the surface recovers from there with the
// relaxation times tau_b of the model's features, and the tool dents it again where it is deeper:
//   dent = max(d, mean_b m_b),   m_b <- d while the force is above 0, else m_b exp(-h / tau_b)
// A model without relaxation times has the dent d. The colour is that of the largest recent error, which decays with
// a time constant of 0.3 s. No force depends on the dent.
// Thread guarantee: one thread; allocates in the constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/tick/features.h"
#include "models/trend/trend_columns.h"

namespace palpate {

class Dent {
 public:
  Dent() = default;
  explicit Dent(const std::vector<FeatureSpec>& features) {
    for (const double time_s : relaxation_times_s(features)) branches_.push_back({time_s, 0.0});
  }

  // `force_N`: of the model; NaN: unknown. `error_over_jnd`: >= 0. `step_s`: time since the last call, s.
  void step(double depth_m, double force_N, double error_over_jnd, double step_s) {
    constexpr double kFading_s = 0.3;
    double sum_m = 0.0;
    for (Branch& branch : branches_) {
      branch.depth_m = force_N > 0.0 ? depth_m : branch.depth_m * std::exp(-step_s / branch.relaxation_time_s);
      sum_m += branch.depth_m;
    }
    const double mean_m = branches_.empty() ? 0.0 : sum_m / static_cast<double>(branches_.size());
    dent_m_ = std::max(depth_m, mean_m);
    error_over_jnd_ = std::max(error_over_jnd, error_over_jnd_ * std::exp(-step_s / kFading_s));
  }

  double depth_m() const noexcept { return dent_m_; }
  double error_over_jnd() const noexcept { return error_over_jnd_; }

 private:
  struct Branch {
    double relaxation_time_s = 0.0, depth_m = 0.0;
  };
  std::vector<Branch> branches_;
  double dent_m_ = 0.0, error_over_jnd_ = 0.0;
};

}  // namespace palpate
