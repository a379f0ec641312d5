// Selects, by cross-validation and the common rule (models/training/selection.h), the two properties of the memory in
// which the trend is not linear in its weights: whether the material's surface lags behind a retreating tool
// (`surface_lag`, engine/tick/features.h), and how the relaxation times change with depth (`slowing`).
// Thread guarantee: slow side.
#pragma once

#include <string>
#include <vector>

#include "models/training/trend_dictionary.h"

namespace palpate {

// The gain of a term of the trend: the cross-validated error in JND (FoldErrors::rms_at_mean_score) with it and without
// it.
struct PartGain {
  std::string name;
  bool taken = false;
  double error_with = 0.0;
  double error_without = 0.0;
};

// Returns `list` with the selected surface and slowing, and appends their gains to `gains`. Errors: those of the
// source; interrupted.
Result<FeatureList> select_memory_law(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                      std::vector<PartGain>& gains, const FitControl& control, double fraction);

// The cross-validated error of the trend without surface lag and slowing, by which two ways to correct the recordings
// are compared. Errors: as above.
Result<FoldErrors> simple_law_error(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                    const FitControl& control, double fraction);

}  // namespace palpate
