// The candidate terms of a trend: a list of features with their constants, the terms of the regression for them, and
// the features and trend made from the weights of the regression.
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

struct FeatureList {
  bool velocity = false;
  // One inner list per feature: the times (seconds) whose branches it sums.
  std::vector<std::vector<double>> relaxation_times_s;
  std::vector<double> stop_thresholds_m;  // of one feature, the sum of the stops
  std::vector<double> creep_times_s;      // of one feature, the sum of the bristles
  double slowing = 0.0;                   // growth of the relaxation times with depth
  std::vector<FeatureSpec> surface{};     // TrendTerms::surface
};

// `sample_s`: mean sampling period; `longest_s`: duration of the longest recording; `depth_m`: greatest depth;
// `encoder_step_m`: 0 where positions are not quantised.
FeatureList dictionary(double sample_s, double longest_s, double depth_m, double encoder_step_m);

// The relaxation times of all features, in order.
std::vector<double> all_times(const FeatureList& list);

// The rows of the regression with the list's terms, at most `most_rows`, with their folds. Samples that follow the
// last used one by less than `least_step_s` are skipped. Errors: those of the source; interrupted.
Result<TrendRows> gather_rows(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                              std::size_t most_rows, double least_step_s, const FitControl& control, double fraction);

// The terms of the regression for the list; without velocity the RMS velocity is not used.
TrendTerms terms_of(const FeatureList& list, double reference_depth_m, double rms_velocity_m_per_s);

// A feature and the columns of the regression whose weighted sum it is.
struct FeatureColumns {
  FeatureKind kind = FeatureKind::depth;
  std::string name;  // for reports, with the range of its constants
  ColumnList columns;
};
// All features of the list that have columns, in the order of the model's features.
std::vector<FeatureColumns> feature_columns(const FeatureList& list, const TrendRows& rows);

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> features;
  // Features x rows: the features at each row, SI.
  Eigen::MatrixXd row_features;
};
// The trend and features for the weights `x` of the regression on `rows`. `all`: keep features whose weights are 0.
FittedTrend fitted_trend(const FeatureList& list, const TrendRows& rows, const Eigen::VectorXd& x, bool all);

}  // namespace palpate
