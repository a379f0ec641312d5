// Identifies one to three relaxation times, for models with few features: `--relaxation auto`, and the recipe of 2009,
// whose authors fitted theirs to the transients of the recording.
//
// The candidates are evenly spaced in log time; each is a group of columns of one regression (trend_regression.h).
// Times are added one by one, by the lowest cross-validated error, after which each may move to the next candidate. A
// further time is kept if the common rule (selection.h) prefers it.
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "models/training/training_extent.h"
#include "models/training/trend_dictionary.h"

namespace palpate {

// Returns seconds, ascending. `count`: 1 to 3, or 0 to select the number by cross-validation. `velocity`: whether the
// trend has viscosity. Errors: recordings too short; those of the source; interrupted.
Result<std::vector<double>> identify_relaxation(MotionSource& source, const TrendProblem& problem,
                                                const TrainingExtent& extent, bool velocity, std::size_t count,
                                                const FitControl& control, double fraction);

}  // namespace palpate
