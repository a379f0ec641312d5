// What is decided about the correction by leaving folds out, of the trend and of the
// correction: its strength, its smoothing, its reach (correction_strength.h), and the bound
// on the error (calibrate_bound.h).
// Thread guarantee: slow side.
#pragma once

#include "models/fit/fit.h"

namespace palpate {

// `row_features`: of the rows, SI, one column a row. `left_out`: the trends without each fold.
// Normalisation, sites and cover of `prepared` are there already. `strokes`: of all recordings.
void decide_strength(PreparedTraining& prepared, const TrendRows& rows, const Eigen::MatrixXd& row_features,
                     const LeftOutTrend& left_out, const TrendProblem& problem, std::size_t strokes);

}  // namespace palpate
