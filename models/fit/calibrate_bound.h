// The error bound of a model (models/model/error_bound.h) from the errors that were
// made on strokes left out.
//
// The three coefficients, never negative, follow the absolute errors by least
// squares, each row scaled by 1 / JND; then all of them are multiplied by the
// quantile of error over bound at which 97.5 % of the samples left out are held: some
// in reserve, since a new recording differs from the training more than
// its strokes among themselves. Away from the data the bound grows by at least a
// quarter of the largest force per unit of normalised distance, whether strokes that
// were left out had been there or not.
// Thread guarantee: slow side, pure.
#pragma once

#include <optional>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/fit/correction_strength.h"
#include "models/model/error_bound.h"

namespace palpate {

// Nothing when there are fewer than 50 predictions.
std::optional<ErrorBound> calibrate_bound(const std::vector<LeftOutPrediction>& predictions, double inner_radius,
                                          const JndLine& jnd, double largest_force_N);

}  // namespace palpate
