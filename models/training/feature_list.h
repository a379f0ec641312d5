// Features besides the depth, as a list of their constants: what selection finds
// (feature_selection.h), a command line asks for, and the trend is fitted with.
// Thread guarantee: value type, pure functions.
#pragma once

#include <vector>

#include "engine/tick/features.h"
#include "models/training/fit_trend.h"

namespace palpate {

struct FeatureList {
  bool velocity = false;
  // One inner list per feature: the times (seconds) whose branches it sums.
  std::vector<std::vector<double>> relaxation_times_s;
  std::vector<double> stop_thresholds_m;  // of one feature, their sum
  std::vector<double> peak_times_s;       // none or one
  double slowing = 0.0;                   // of the relaxation times
  bool spline_elastic = false;            // as in TrendTerms
  bool spline_branches = false;
  std::vector<FeatureSpec> surface{};     // TrendTerms::surface; needs spline_elastic
};

std::vector<double> all_times(const FeatureList& list);

// The terms of the trend that go with the list.
TrendTerms terms_of(const FeatureList& list, double reference_depth_m, double rms_velocity_m_per_s);

// The features, with the drives that a trend of exactly these terms was fitted with;
// thresholds that carry nothing are left out.
std::vector<FeatureSpec> features_of(const FeatureList& list, const FittedTrend& fitted);

}  // namespace palpate
