// What cross-validation decides about the correction: its strength, its smoothing, its reach
// (correction_strength.h); and of every fitted method its error and the bound on it
// (models/model/error_bound.h).
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
                     const CrossValidated& left_out, const TrendProblem& problem, std::size_t strokes);

// The errors of a method on every row without its fold: the method is fitted again without each fold,
// to at most kLeftOutSites rows, and corrects the trend without that fold. Without a method, or with
// strength 0, those of the trend. Errors: those of the method; interrupted.
Result<std::vector<LeftOutPrediction>> cross_validate(const PreparedTraining& prepared, const MethodRequest* request,
                                                      const FitControl& control);
// The bound that these errors give for a model of `prepared`.
std::optional<ErrorBound> bound_of(const PreparedTraining& prepared, const std::vector<LeftOutPrediction>& errors);

}  // namespace palpate
