// What a trend may be made of, and what became of it: a list of features with their
// constants, the terms of the regression that go with it, and the features and the
// trend with the weights that the regression found.
//
// The dictionary is the list with everything that a recording of this length and rate could show:
//   velocity    viscosity
//   relaxation  Maxwell branches, kTimesPerDecade to a decade, from two samples to
//               a third of the recording; in three bands (fast, middle, slow), each of
//               which becomes one feature, the sum of its branches
//   stops       a Prandtl-Ishlinskii operator of kStops stops, whose thresholds halve from half of
//               the greatest depth down to the encoder's step
//   creep       bristles that creep by a power law, a time for each decade
// Nothing is chosen from it: weights of what does not help become 0.
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
  std::vector<double> stop_thresholds_m;  // of one feature, their sum
  std::vector<double> creep_times_s;      // likewise
  double slowing = 0.0;                   // of the relaxation times
  std::vector<FeatureSpec> surface{};     // TrendTerms::surface
};

// `sample_s`: the mean step of the recordings; `longest_s`: how long the longest is; `depth_m`: their
// greatest depth; `encoder_step_m`: 0 where positions are not quantised.
FeatureList dictionary(double sample_s, double longest_s, double depth_m, double encoder_step_m);

std::vector<double> all_times(const FeatureList& list);

// The rows of the list's terms, at most so many, with their folds. Errors: those of the
// source; interrupted. `least_step_s`: samples sooner than this after the last are left out.
Result<TrendRows> gather_rows(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                              std::size_t most_rows, double least_step_s, const FitControl& control, double fraction);

// The terms of the trend that go with the list.
TrendTerms terms_of(const FeatureList& list, double reference_depth_m, double rms_velocity_m_per_s);

// A feature with the columns of the regression that it sums.
struct FeatureColumns {
  FeatureKind kind = FeatureKind::depth;
  std::string name;  // of a part of the dictionary, in words
  ColumnList columns;
};
// Of every feature of the list that has columns, in the features' order.
std::vector<FeatureColumns> feature_columns(const FeatureList& list, const TrendRows& rows);

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> features;
  // Of every row the features, SI: as many rows as features, one column a row.
  Eigen::MatrixXd row_features;
};
// What the weights `x` make of the rows and of the list that they are of. `all`: features
// that carry nothing stay, too.
FittedTrend fitted_trend(const FeatureList& list, const TrendRows& rows, const Eigen::VectorXd& x, bool all);

}  // namespace palpate
