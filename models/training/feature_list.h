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
};

std::vector<double> all_times(const FeatureList& list);

// The features, with the drives that a trend of exactly these terms was fitted with;
// thresholds that carry nothing are left out.
std::vector<FeatureSpec> features_of(const FeatureList& list, const FittedTrend& fitted);

}  // namespace palpate
