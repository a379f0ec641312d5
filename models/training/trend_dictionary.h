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
#include "models/training/training_extent.h"
#include "models/training/trend_regression.h"
#include "models/training/trend_rows.h"

namespace palpate {

// `encoder_step_m`: 0 where positions are not quantised.
FeatureList dictionary(const TrainingExtent& extent, double encoder_step_m);
// The relaxation times of the dictionary in s, ascending.
std::vector<double> dictionary_times_s(const TrainingExtent& extent);

// A list with a feature of its own for each relaxation time.
FeatureList single_times(bool velocity, const std::vector<double>& times_s);

// The training data of all regressions of one step of a fit.
struct TrendData {
  MotionSource& source;
  TrendProblem problem;
  FitControl control;
};

// The rows of the regression with the list's terms. While there are more than `most_rows`, every other one is dropped.
// Samples that follow the last used one by less than `least_step_s` are skipped. Errors: interrupted.
Result<TrendRows> gather_rows(const TrendData& data, const FeatureList& list, std::size_t most_rows,
                              double least_step_s = 0.0);

// The name of a candidate feature in reports, with the range of its constants.
std::string term_name(const FeatureSpec& spec);

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> features;
  // Features x rows: the features at each row, SI.
  Eigen::MatrixXd row_features;
};
// The trend and features for the weights `x` of the regression on `rows`. `all`: keep features whose weights are 0.
FittedTrend fitted_trend(const TrendRows& rows, const Eigen::VectorXd& x, bool all);

}  // namespace palpate
