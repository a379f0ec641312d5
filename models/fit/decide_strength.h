// What is decided about the correction by leaving folds out, of the trend and of the
// correction: its strength, its smoothing, its reach (correction_strength.h), and the bound
// on the error (models/model/error_bound.h).
// Thread guarantee: slow side.
#pragma once

#include "models/fit/fit.h"

namespace palpate {

// The error bound of a model (models/model/error_bound.h), from the errors that were
// made on strokes left out.
//
// No bound is closer than what counts as no force (sensor_identification.h): without that it held
// 77 to 90 % on skin and 83 on one trial of silicone, with it 97 to 100. The three coefficients, never negative, follow
// the absolute errors by least squares, each row scaled by 1 / JND; then all of them are multiplied by the quantile of
// error over bound at which 97.5 % of the samples left out are held: some in reserve, since a new recording differs
// from the training more than its strokes among themselves. Away from the data the bound grows by at least a quarter of
// the largest force per unit of normalised distance, whether strokes that were left out had been there or not. Nothing
// when there are fewer than 50 predictions. Pure.
std::optional<ErrorBound> calibrate_bound(const std::vector<LeftOutPrediction>& predictions, double inner_radius,
                                          const JndLine& jnd, double largest_force_N);

// `row_features`: of the rows, SI, one column a row. `left_out`: the trends without each fold.
// Normalisation, sites and cover of `prepared` are there already. `strokes`: of all recordings.
void decide_strength(PreparedTraining& prepared, const TrendRows& rows, const Eigen::MatrixXd& row_features,
                     const LeftOutTrend& left_out, const TrendProblem& problem, std::size_t strokes);

}  // namespace palpate
