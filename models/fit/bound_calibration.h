// The error bound of a model (models/model/fitted_model.h) from its cross-validated errors.
// Thread guarantee: slow side.
#pragma once

#include <optional>
#include <vector>

#include "models/fit/fit.h"

namespace palpate {

// The prediction of one row by a model fitted without its fold.
struct CrossValidationPrediction {
  double error_N = 0.0;  // absolute error of the force
  double predicted_N = 0.0;
  double distance = 0.0;  // to the nearest row of another fold
};

// Calibrates the error bound of a model (models/model/fitted_model.h) with cross-validated errors.
//
// The non-negative coefficients are fitted to the absolute errors by least squares, with rows scaled by 1 / JND. Then
// all are multiplied by the quantile of error over bound that gives a coverage of 97.5 % of the rows: more than 95 %,
// because a new recording differs more from the training than its strokes from each other. The floor is at least 10 mN
// (kForceFloor_N): without this minimum the coverage was 77 to 90 % on skin and 83 % on one trial of silicone, with it
// 97 to 100 %. The bound grows by at least a quarter of the largest force per unit of normalised distance. Empty with
// fewer than 50 predictions. Pure.
std::optional<ErrorBound> calibrate_bound(const std::vector<CrossValidationPrediction>& predictions,
                                          double inner_radius, const JndLine& jnd, double largest_force_N);

// The sites of a correction without a fold, at most 1500. The targets are the strength times the residuals of the trend
// without that fold.
Sites sites_without(const PreparedTraining& prepared, int fold);

// The error bound of a model of `prepared`; with fewer than three strokes it is at least 5 % of the force.
// `corrections`: fitted to `sites_without` each fold; empty: none, the errors are those of the trend.
std::optional<ErrorBound> bound_of(const PreparedTraining& prepared, const std::vector<CorrectionPtr>& corrections);

}  // namespace palpate
