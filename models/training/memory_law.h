// Selects the properties of the memory in which the trend is not linear in its weights, by cross-validation and the
// common rule (cross_validation.h): whether the material's surface lags behind a retreating tool (`surface_lag`,
// engine/tick/features.h), how the relaxation times change with depth (`slowing`), and, for models with few features
// (`--relaxation auto`, and the recipe of 2009, whose authors fitted theirs to the transients of the recording), one to
// three relaxation times.
// Thread guarantee: slow side.
#pragma once

#include <string>
#include <vector>

#include "models/training/training_extent.h"
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

// Returns relaxation times in seconds, ascending. The candidates are evenly spaced in log time; each is a group of
// columns of one regression. Times are added one by one, by the lowest cross-validated error, after which each may move
// to the next candidate. `count`: 1 to 3, or 0: a further time is kept if the common rule prefers it. `velocity`:
// whether the trend has viscosity. Errors: recordings too short; those of the source; interrupted.
Result<std::vector<double>> identify_relaxation(MotionSource& source, const TrendProblem& problem,
                                                const TrainingExtent& extent, bool velocity, std::size_t count,
                                                const FitControl& control, double fraction);

}  // namespace palpate
