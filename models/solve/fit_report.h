// The results of a fit with its diagnostics.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {

struct FitReport {
  Eigen::Index centres_used = 0;
  // Condition number of the solved system: of the columns scaled to length 1, or of the smoothed matrix (direct).
  double condition = 0.0;
  // sqrt(mean(row_scale^2 (f - h)^2)) over the sites.
  double residual_rms = 0.0;
  // The factor of the penalty (penalised_weights.h).
  double smoothing = 0.0;
  // Sentences for the user: what was clamped, truncated or skipped.
  std::vector<std::string> notes;
};

struct FittedRbf {
  RbfFunction function;
  FitReport report;
};

}  // namespace palpate
