#include "models/fit/fit.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "models/correction/algebra.h"
#include "tests/support/exact_samples.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

// Four rows on a line, in two folds whose trends differ.
ResidualRows four_rows() {
  ResidualRows rows;
  rows.points = Eigen::RowVector4d(0.0, 1.0, 1.25, 4.0);
  rows.force_N = Eigen::Vector4d(1.0, 0.0, 3.0, 4.0);
  rows.depth_m = Eigen::Vector4d::Constant(1e-3);
  rows.row_scale = Eigen::Vector4d(1.0, 2.0, 3.0, 4.0);
  rows.trend_N.resize(4, 2);
  rows.trend_N.col(0) << 0.5, -0.5, 2.0, 3.5;
  rows.trend_N.col(1) << 0.75, -0.25, 3.5, 4.25;
  rows.fold = {0, 0, 1, 1};
  rows.no_force = {0, 1, 0, 0};
  rows.find_distances();
  return rows;
}

// The second row has no force: a trend below 0 needs no correction there.
TEST(ResidualRows, SitesHaveTheResidualsOfTheTrendWithoutTheFold) {
  const Sites first = four_rows().sites_without(0, 0.1);
  EXPECT_EQ(first.target_N, Eigen::Vector2d(1.0, 0.5));
  EXPECT_EQ(first.row_scale, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(first.points, Eigen::RowVector2d(1.25, 4.0));
  EXPECT_EQ(first.smoothing, 0.1);
  const Sites second = four_rows().sites_without(1, 0.1);
  EXPECT_EQ(second.target_N, Eigen::Vector2d(0.25, 0.0));
  EXPECT_EQ(second.points, Eigen::RowVector2d(0.0, 1.0));
}

TEST(ResidualRows, ThePredictionIsThatOfTheOtherFolds) {
  const ResidualRows rows = four_rows();
  EXPECT_EQ(rows.distance, (std::vector<double>{1.25, 0.25, 0.25, 3.0}));
  ModelData common;
  common.correction_limit_N = 0.4;
  common.cover = {{}, 0.5, 1.0};
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 2, 0.5, 0.3), 3.8) << "within the inner radius";
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 2, 0.5, 0.9), 3.9) << "the correction is limited";
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 0, 0.5, 0.3), 0.5) << "beyond the outer radius only the trend counts";
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 1, 0.5, 0.3), 0.0) << "no force below the lowest";
}

double between(test::Numbers& numbers, double low, double high) {
  return low + 0.5 * (high - low) * (numbers.next() + 1.0);
}

constexpr int kFolds = 5;

// `shared`: size of the residual common to all strokes. `own`: size of the residual that differs
// between strokes. `first`: additional share of the rows in the first stroke.
ResidualRows make_rows(double shared, double own, double first = 0.0) {
  test::Numbers numbers(3);
  constexpr Eigen::Index kRows = 1000;
  ResidualRows rows;
  rows.points.resize(2, kRows);
  rows.force_N.resize(kRows);
  rows.depth_m = Eigen::VectorXd::Constant(kRows, 1e-3);
  rows.row_scale = Eigen::VectorXd::Constant(kRows, 1.0 / 0.1);
  rows.trend_N = Eigen::MatrixXd::Constant(kRows, kFolds, 2.0);
  rows.no_force.assign(kRows, 0);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double along = (static_cast<double>(i) / kRows - first) / (1.0 - first);
    const int fold = along > 0.0 ? static_cast<int>(along * kFolds) : 0;
    for (Eigen::Index k = 0; k < 2; ++k) rows.points(k, i) = between(numbers, -1.0, 1.0);
    rows.force_N(i) =
        2.0 + shared * std::sin(3.0 * rows.points(0, i)) + own * std::cos(2.0 * fold) + between(numbers, -0.005, 0.005);
    rows.fold.push_back(fold);
  }
  rows.find_distances();
  return rows;
}

CorrectionChoice choose(const ResidualRows& rows) {
  ModelData common;
  common.correction_limit_N = 1.0;
  common.cover = {{}, 0.1, 0.3};
  return choose_correction(rows, common);
}

TEST(CorrectionChoice, WhatEveryStrokeHasIsCorrected) {
  const CorrectionChoice choice = choose(make_rows(0.3, 0.0));
  EXPECT_TRUE(choice.used);
  // The remaining error is the noise of 5 mN (with a JND of 190 mN) and the smoothing bias.
  EXPECT_LT(choice.error_over_jnd, 0.1 * choice.trend_error_over_jnd);
}

// The first stroke has nine tenths of the squared error, but every stroke has the same weight.
TEST(CorrectionChoice, AStrokeWithMostOfTheErrorHasOneVoteOfAll) { EXPECT_TRUE(choose(make_rows(0.3, 0.0, 0.8)).used); }

TEST(CorrectionChoice, WhatOnlyOneStrokeHasIsNot) {
  const CorrectionChoice choice = choose(make_rows(0.0, 0.3));
  EXPECT_FALSE(choice.used);
  EXPECT_EQ(choice.error_over_jnd, choice.trend_error_over_jnd);
}

// Every row has close rows of other strokes, so a larger reach than 0.1 has no significant
// gain in cross-validation.
TEST(CorrectionChoice, ReachesNoFartherThanStrokesLeftOutReward) {
  const CorrectionChoice choice = choose(make_rows(0.3, 0.1));
  EXPECT_TRUE(choice.used);
  EXPECT_EQ(choice.inner_radius, 0.1);
}

TEST(CorrectionChoice, NeverWorseThanNoneOnWhatIsLeftOut) {
  for (const double own : {0.05, 0.1, 0.2}) {
    const CorrectionChoice choice = choose(make_rows(0.1, own));
    EXPECT_LE(choice.error_over_jnd, choice.trend_error_over_jnd) << own;
  }
}

TEST(CorrectionChoice, NothingToLeaveOutMeansNone) { EXPECT_FALSE(choose({}).used); }

std::optional<ErrorBound> bound_of(const std::vector<Prediction>& predictions) {
  ModelData common;
  common.largest_force_N = 5.0;
  return fit_bound(predictions, common);
}

// `units` of 50 rows with the error 0.1 N times their number, from 1 on, at a force of 1 N.
std::vector<Prediction> of_units(int units) {
  std::vector<Prediction> predictions;
  for (int i = 0; i < 50 * units; ++i) predictions.push_back({0.1 * (i / 50 + 1), 1.0, 0.0, i / 50});
  return predictions;
}

// Units whose errors differ in scale, as those of recordings do.
TEST(FitBound, CoversNewUnitsAndGrowsAwayFromTheData) {
  test::Numbers numbers(5);
  std::vector<Prediction> past, future;
  for (int unit = 0; unit < 80; ++unit) {
    const double scale = std::exp(between(numbers, -1.0, 1.0));
    for (int i = 0; i < 100; ++i) {
      const double force_N = between(numbers, 0.0, 5.0);
      // A triangular error that grows with the force.
      const double error_N =
          scale * (0.01 + 0.02 * force_N) * std::abs(between(numbers, -1.0, 1.0) + between(numbers, -1.0, 1.0));
      (unit % 2 == 0 ? past : future).push_back({error_N, force_N, 0.0, unit});
    }
  }
  const ErrorBound bound = bound_of(past).value();
  int covered = 0;
  for (std::size_t unit = 0; unit < 40; ++unit) {
    const auto first = future.begin() + static_cast<std::ptrdiff_t>(100 * unit);
    const auto within = [&](const Prediction& one) { return one.error_N <= bound.at(one.predicted_N, 0.0); };
    covered += std::count_if(first, first + 100, within) >= 95 ? 1 : 0;
  }
  // Nine of ten are expected; the tolerance is three standard deviations.
  EXPECT_GE(covered, 36 - 6);
  EXPECT_GE(bound.at(1.0, 1.0), bound.at(1.0, 0.0) + 1.25) << "a quarter of the largest force";
}

// One row of 50, too few for the 95 % quantile of all, has an error of 1 N: in no phase, or first, or deep, or fast.
TEST(FitBound, HoldsInEveryPhase) {
  struct Phase {
    std::size_t row;
    double depth_m, speed_m_per_s, bound_N;
  };
  for (const Phase& phase : {Phase{25, 0.0, 0.0, 0.1}, {0, 0.0, 0.0, 1.0}, {25, 1e-3, 0.0, 1.0}, {25, 0.0, 0.1, 1.0}}) {
    std::vector<Prediction> predictions = of_units(2);
    for (Prediction& one : predictions) one.error_N = 0.1;
    for (std::size_t unit = 0; unit < 2; ++unit)
      predictions[50 * unit + phase.row] = {1.0, 1.0, 0.0, static_cast<int>(unit), phase.depth_m, phase.speed_m_per_s};
    EXPECT_NEAR(bound_of(predictions)->at(1.0, 0.0), phase.bound_N, 0.011) << phase.depth_m << phase.speed_m_per_s;
  }
}

// Three recordings whose surfaces differ by 1 mm, in a material of 1 N/mm: nothing else is left, and the next surface
// has the error 1 mm sqrt(2 x 8 / 27). A single one has that of its own surface.
TEST(FitBound, GrowsByTheErrorOfTheSurface) {
  std::vector<Prediction> predictions;
  for (int i = 0; i < 150; ++i) predictions.push_back({i / 50 - 1.0, 3.0, 0.0, i / 50, 4e-3});
  ModelData common;
  common.largest_force_N = 5.0;
  common.trend.reference_depth_m = 8e-3;
  common.trend.elastic = test::even_spline(8.0, 8.0);
  common.provenance.offsets.resize(3);
  const ErrorBound several = fit_bound(predictions, common).value();
  EXPECT_NEAR(several.surface_error_m, 1e-3 * std::sqrt(16.0 / 27.0), 1e-5);
  EXPECT_LT(several.at(3.0, 0.0), 0.02);
  common.provenance.offsets = {{"press", 0.0, 2e-4}};
  const ErrorBound one = fit_bound(predictions, common).value();
  EXPECT_EQ(one.surface_error_m, 2e-4);
  EXPECT_GT(one.at(3.0, 0.0), 0.9);
}

// Errors of 3 N for each unit of distance beyond the inner radius, 0.1; a recording that as recorded reads 0.2 N more.
TEST(FitBound, DistancesCountFromTheInnerRadiusAndForcesAsRecorded) {
  constexpr Eigen::Index kRows = 200;
  ResidualRows rows;
  rows.points = Eigen::MatrixXd::Zero(1, kRows);
  rows.force_N = Eigen::VectorXd::Constant(kRows, 2.0);
  rows.depth_m = rows.speed_m_per_s = rows.moved_N = Eigen::VectorXd::Zero(kRows);
  rows.trend_N.resize(kRows, 2);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    rows.fold.push_back(i < kRows / 2 ? 0 : 1);
    rows.unit.push_back(rows.fold.back());
    rows.distance.push_back(0.5 * static_cast<double>(i % 100) / 100.0);
    rows.trend_N.row(i).setConstant(2.0 - 3.0 * std::max(0.0, rows.distance.back() - 0.1));
  }
  ModelData common;
  common.cover = {{}, 0.1, 0.3};
  common.largest_force_N = 5.0;
  const ErrorBound bound = fit_bound(predictions_of(rows, common, {}), common).value();
  EXPECT_NEAR(bound.per_distance_N, 3.0, 0.1);
  EXPECT_LT(bound.at(2.0, 0.0), 0.05);
  rows.moved_N.tail(kRows / 2).setConstant(-0.2);
  EXPECT_NEAR(predictions_of(rows, common, {}).back().error_N - predictions_of(rows, common, {})[99].error_N, -0.2,
              1e-12);
}

constexpr int kPlaces = 300;
constexpr int kRepeats = 4;
constexpr Eigen::Index kRows = kPlaces * kRepeats;

// A force of two normalised coordinates, 2 to 4 N, with details that take some hundred centres.
double true_force_N(const Eigen::VectorXd& u) { return 3.0 + std::sin(9.0 * u(0)) * std::cos(7.0 * u(1)); }

// Samples at random places in depth and velocity, each of which comes back four times: in other folds, almost at the
// same point, with other noise.
struct Repeated {
  Samples samples;
  Eigen::MatrixXd features;
  Normalisation normalisation;
  Sites sites;
  ModelData common;
};

// `force_of`: the force, N, of the place and the number of a sample; may move the place.
template <typename Force>
Repeated repeated_places(const Force& force_of) {
  Repeated made;
  test::Numbers numbers(5);
  const Eigen::MatrixXd places = test::random_points(2, kPlaces, 3);
  const Eigen::Vector2d middle(3e-3, 0.0), size(2e-3, 0.05);
  made.features.resize(2, kRows);
  made.samples = test::exact_samples(static_cast<std::size_t>(kRows), 5e-3, [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    Eigen::Vector2d u = places.col(row % kPlaces);
    const Eigen::Vector2d moved = 1e-9 * Eigen::Vector2d(numbers.next(), numbers.next());
    const double force_N = force_of(u, i) + 0.2 * numbers.next();
    made.features.col(row) = middle + size.cwiseProduct(u + moved);
    return test::ExactRow{1e-3 * static_cast<double>(i), made.features(0, row), made.features(1, row), force_N,
                          static_cast<int>(5 * row / kRows)};
  });
  made.normalisation = normalisation_of(made.features);
  double step_N = 0.0;
  made.sites = thin(made.samples, made.features, made.normalisation, Thinning::none, step_N);
  made.sites.target_N = made.sites.force_N;
  made.sites.row_scale = made.sites.force_N.cwiseInverse();
  made.common.largest_force_N = made.samples.force_N;
  return made;
}
Repeated repeated_places() {
  return repeated_places([](const Eigen::Vector2d& u, std::size_t) { return true_force_N(u); });
}

TEST(OpenChoices, CanBeInterruptedBeforeEachSetting) {
  const Repeated from = repeated_places();
  for (int stop = 1; stop <= 6; ++stop) {
    int asked = 0;
    const FitControl control{[&](double) { return ++asked < stop; }};
    EXPECT_EQ(test::message_of(select_open_choices(from.samples, from.features, from.normalisation, from.sites,
                                                   from.common, 20, {}, control)),
              "interrupted");
    EXPECT_EQ(asked, stop);
  }
}

}  // namespace
}  // namespace palpate
