// Selects, by cross-validation and the selection rule (cross_validation.h), the parameters of the memory that a linear
// regression cannot identify: whether the material's surface lags behind a retreating tool (`surface_lag`,
// engine/tick/features.h), and how the relaxation times change with depth (`slowing`). For models with few features
// (`--relaxation auto`, and the methods of the paper, whose authors fitted theirs to the transients of the recording)
// it selects one to three relaxation times. Thread guarantee: slow side.
#pragma once

#include <string>
#include <vector>

#include "models/trend/trend_estimator.h"

namespace palpate {

// The gain of a term of the trend: the cross-validated error in JND (FoldErrors::rms_at_mean_score) with it and without
// it.
struct PartGain {
  std::string name;
  bool taken = false;
  double error_with = 0.0;
  double error_without = 0.0;
};

// Returns `list` with the selected surface and slowing, and appends their gains to `gains`. Errors: interrupted.
Result<FeatureList> select_memory_law(const Samples& samples, const TrendWeights& weights, const FeatureList& list,
                                      std::vector<PartGain>& gains, const FitControl& control);

// Selects relaxation times from those of the dictionary (ascending, in s). Each candidate is a feature of one
// regression. Times are added one by one, by the lowest cross-validated error; after each addition, times move to
// neighbouring candidates while the error falls. `count`: 1 to 3, or 0: a further time is kept if the selection rule
// prefers it. `velocity`: whether the trend has viscosity. Errors: no candidates (recordings too short); interrupted.
Result<std::vector<double>> identify_relaxation(const Samples& samples, const TrendWeights& weights, bool velocity,
                                                std::size_t count, const FitControl& control);

}  // namespace palpate
