// One to three relaxation times of the branches that explain the recordings best, for who
// asks for so few features (`--relaxation auto`, and the 2009 recipe, whose authors fitted
// theirs to the transients of the recording).
//
// Every set of one, two and three times of a ladder is a set of columns of one regression
// (trend_regression.h); of the best set of each size, one more time stays where the folds
// left out reward it (selection.h).
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "models/training/training_extent.h"
#include "models/training/trend_dictionary.h"

namespace palpate {

// Seconds, ascending. `count`: one to three; 0: as many as the folds reward. Errors: those of the source; interrupted.
Result<std::vector<double>> identify_relaxation(MotionSource& source, const TrendProblem& problem,
                                                const TrainingExtent& extent, bool velocity, std::size_t count,
                                                const FitControl& control, double fraction);

}  // namespace palpate
