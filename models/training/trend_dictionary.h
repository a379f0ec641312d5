// The candidate terms of a trend, and the features and trend made from the weights of their regression.
//
// The dictionary is the list of all terms that a recording of this length and rate can identify:
//   velocity    viscosity
//   relaxation  Maxwell branches, four relaxation times a decade, from two samples (at least 1 ms) to a third of the
//               recording (at most 100 s), in three bands (fast, middle, slow). The sum of a band is one feature.
//   stops       a Prandtl-Ishlinskii operator of up to 8 stops, whose thresholds halve from half of the greatest depth
//               down to the encoder step
//   creep       bristles that creep by a power law, one time a decade, from 1 ms to the same limit
// The non-negative regression sets the weights of terms that do not help to 0.
// Thread guarantee: value types, pure functions.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/model/trend.h"
#include "models/training/motion_source.h"
#include "models/training/trend_regression.h"
#include "models/training/trend_rows.h"

namespace palpate {

// `sample_s`: mean sampling period; `longest_s`: duration of the longest recording; `depth_m`: greatest depth;
// `encoder_step_m`: 0 where positions are not quantised.
FeatureList dictionary(double sample_s, double longest_s, double depth_m, double encoder_step_m);

// The rows of the regression with the list's terms, at most `most_rows`, with their folds. Samples that follow the
// last used one by less than `least_step_s` are skipped. Errors: those of the source; interrupted.
Result<TrendRows> gather_rows(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                              std::size_t most_rows, double least_step_s, const FitControl& control, double fraction);

// A feature and the columns of the regression whose weighted sum it is.
struct FeatureColumns {
  FeatureKind kind = FeatureKind::depth;
  std::string name;               // for reports, with the range of its constants
  std::vector<double> constants;  // relaxation times, thresholds or creep times
  ColumnList columns;
};
// All features of the rows' list that have columns, in the order of the model's features.
std::vector<FeatureColumns> feature_columns(const TrendRows& rows);

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> features;
  // Features x rows: the features at each row, SI.
  Eigen::MatrixXd row_features;
};
// The trend and features for the weights `x` of the regression on `rows`. `all`: keep features whose weights are 0.
FittedTrend fitted_trend(const TrendRows& rows, const Eigen::VectorXd& x, bool all);

}  // namespace palpate
