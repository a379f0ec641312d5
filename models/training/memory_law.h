// The laws of memory in which the trend is not linear, by cross-validation and the common rule
// (models/training/selection.h): whether the material's surface stays behind a tool that
// retreats fast (`surface_lag`, engine/tick/features.h), and whether its relaxation times grow
// or shrink with depth (`slowing`).
// Thread guarantee: slow side.
#pragma once

#include <string>
#include <vector>

#include "models/training/trend_dictionary.h"

namespace palpate {

// The gain of a part of the trend: the cross-validated error in JND (FoldErrors::typical) with it and without it.
struct PartGain {
  std::string name;
  bool taken = false;
  double error_with = 0.0;
  double error_without = 0.0;
};

// `list` with the surface and the slowing that were selected. Appends to `gains`. Errors: those of the source;
// interrupted.
Result<FeatureList> select_memory_law(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                      std::vector<PartGain>& gains, const FitControl& control, double fraction);

}  // namespace palpate
