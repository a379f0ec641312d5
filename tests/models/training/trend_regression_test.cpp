#include "models/training/trend_regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/training/acceptance.h"
#include "models/training/trend_dictionary.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;
constexpr int kFolds = 5;

// Strokes of growing depth and speed, a second each, measured at 500 Hz.
template <typename Force>
TrendRows rows_of(const FeatureList& list, Force force_N) {
  TrendRows rows(terms_of(list, kDepth_m, 0.02));
  rows.begin_recording();
  for (int i = 0; i < 10000; ++i) {
    const double t = 2e-3 * i;
    const int stroke = i / 500;
    const double angle = 2.0 * std::numbers::pi * (1.0 + stroke % 3) * t;
    const double amplitude_m = kDepth_m * (0.5 + 0.025 * stroke);
    const double position_m = amplitude_m * std::sin(angle);
    const ToolSample sample{t, position_m, 0.0, 0.0};
    const MotionEstimate motion{position_m,
                                amplitude_m * std::cos(angle) * 2.0 * std::numbers::pi * (1.0 + stroke % 3)};
    rows.add(sample, motion, force_N(sample, motion), stroke % kFolds);
  }
  return rows;
}

double rms_of(const TrendRows& rows, const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    const double error_N = Eigen::Map<const Eigen::VectorXd>(rows.row(i), x.size()).dot(x) - rows.force_N(i);
    sum += error_N * error_N;
  }
  return std::sqrt(sum / static_cast<double>(rows.count()));
}

TEST(TrendRegression, FindsWhatIsInTheDictionaryAndMakesNothingNegative) {
  FeatureFilter branch({{FeatureKind::maxwell_branch, 0.1, {kDepth_m, {1.5, 0.5, 0.0, 0.0}}}});
  FeatureList list;
  list.velocity = true;
  list.relaxation_times_s = {{0.01, 0.1, 1.0}};
  const TrendRows rows = rows_of(list, [&](const ToolSample& sample, const MotionEstimate& motion) {
    const double u = std::max(0.0, motion.position_m) / kDepth_m;
    return 2.0 * u + u * u + branch.update(sample, motion).values[0];
  });
  const TrendRegression regression(rows, kFolds, Weighting::jnd, JndLine{}, -100.0);
  const Eigen::VectorXd x = regression.solve(regression.all_columns());
  EXPECT_GE(x.minCoeff(), 0.0);
  // Of up to 4.5 N; the penalty takes what a part's own error of a tenth leaves uncertain.
  EXPECT_LT(rms_of(rows, x), 0.02);
  EXPECT_LT(regression.left_out(regression.all_columns()).rms(), 0.2);
}

// On the way in the force is 3 N at the greatest depth, and one sample in four of the way
// out finds none: the tool has left the material there.
TEST(TrendRegression, AForceThatWasNotMeasuredIsNoForceToFollow) {
  int sample_number = 0;
  const TrendRows rows = rows_of(FeatureList{}, [&](const ToolSample&, const MotionEstimate& motion) {
    const bool left = motion.velocity_m_per_s < 0.0 && ++sample_number % 4 == 0;
    return left ? 0.0 : 3.0 * std::max(0.0, motion.position_m) / kDepth_m;
  });
  const TrendRegression regression(rows, kFolds, Weighting::jnd, JndLine{}, 0.01);
  const Trend trend = fitted_trend({}, rows, regression.solve(regression.all_columns()), true).trend;
  const double at[] = {kDepth_m};
  // Within a JND: what no feature explains is scaled down (weighting.h).
  EXPECT_NEAR(trend.at(at, {FeatureSpec{}}), 3.0, 0.25);
}

TEST(Acceptance, TakesTheLessSimpleForTwoStandardErrorsAlone) {
  const std::vector<double> simple{10.0, 12.0, 11.0, 13.0, 9.0};
  EXPECT_TRUE(is_worth_it({9.0, 11.0, 10.0, 12.0, 8.0}, simple)) << "the same gain in every fold";
  EXPECT_FALSE(is_worth_it({1.0, 14.0, 12.0, 14.0, 10.0}, simple)) << "one fold's gain";
  EXPECT_FALSE(is_worth_it(simple, simple));
  EXPECT_TRUE(is_as_good(simple, simple));
  EXPECT_TRUE(is_as_good({10.0, 12.0, 12.0, 13.0, 9.0}, simple));
  EXPECT_FALSE(is_as_good({11.0, 13.0, 12.0, 14.0, 10.0}, simple));
}

TEST(Acceptance, EveryBlockHasOneVoiceWhereCandidatesDifferInKind) {
  // Trend and corrected trend on two presses of a foam slab whose force begins below 0: by the
  // sum, 610 with a standard error of 421, it could not be told.
  const std::vector<double> trend{470.0, 102.0, 51.6, 3.57, 5.50};
  const std::vector<double> corrected{18.7, 3.07, 0.59, 0.40, 0.37};
  EXPECT_FALSE(is_worth_it(corrected, trend));
  EXPECT_TRUE(is_certainly_worse(trend, corrected));
  EXPECT_FALSE(is_certainly_worse(corrected, trend));
  EXPECT_FALSE(is_certainly_worse(trend, trend));
  EXPECT_FALSE(is_certainly_worse({9.0, 1.0, 1.0, 1.0, 1.0}, {1.0, 1.3, 1.2, 1.2, 1.1})) << "one block's gain";
}

}  // namespace
}  // namespace palpate
