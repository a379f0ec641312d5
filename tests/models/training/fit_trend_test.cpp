#include "models/training/fit_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "models/model/bernstein.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 6e-3;
constexpr double kThinning_m_per_s = 0.03;

Eigen::VectorXd vector_of(const nlohmann::json& values) {
  Eigen::VectorXd vector(static_cast<Eigen::Index>(values.size()));
  for (Eigen::Index i = 0; i < vector.size(); ++i) vector[i] = values.at(static_cast<std::size_t>(i)).get<double>();
  return vector;
}

// Against scipy.optimize.nnls; tests/golden/nnls_scipy.py made the file. The
// ridge of 1e-8 moves a solution of condition up to 1e3 by about 1e-5.
TEST(SolveNonNegative, AgreesWithScipy) {
  std::ifstream file(std::filesystem::path(PALPATE_SOURCE_DIR) / "tests/golden/nnls_scipy.json");
  ASSERT_TRUE(file.is_open());
  const auto golden = nlohmann::json::parse(file);
  ASSERT_EQ(golden.at("cases").size(), 8U);
  for (const auto& item : golden.at("cases")) {
    const Eigen::VectorXd b = vector_of(item.at("right_side"));
    Eigen::MatrixXd gram(b.size(), b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) gram.row(i) = vector_of(item.at("gram").at(static_cast<std::size_t>(i)));
    const Eigen::VectorXd x = solve_non_negative(gram, b);
    const Eigen::VectorXd expected = vector_of(item.at("x"));
    EXPECT_GE(x.minCoeff(), 0.0);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-5 * (1.0 + expected.maxCoeff())) << b.size();
    const double squares = item.at("squares").get<double>() - 2.0 * b.dot(x) + x.dot(gram * x);
    const double residual = item.at("residual").get<double>();
    EXPECT_NEAR(squares, residual * residual, 1e-7 * (1.0 + residual * residual)) << b.size();
  }
}

TEST(SolveNonNegative, SurvivesZeroEqualAndUselessColumns) {
  Eigen::MatrixXd gram(3, 3);
  gram << 4.0, 4.0, 0.0, 4.0, 4.0, 0.0, 0.0, 0.0, 0.0;
  const Eigen::VectorXd x = solve_non_negative(gram, Eigen::Vector3d(8.0, 8.0, 0.0));
  EXPECT_NEAR(x(0) + x(1), 2.0, 1e-6);  // the ridge
  EXPECT_EQ(x(2), 0.0);
  EXPECT_EQ(solve_non_negative(gram, Eigen::Vector3d(-8.0, -8.0, 0.0)), Eigen::VectorXd(Eigen::VectorXd::Zero(3)));
  EXPECT_EQ(solve_non_negative(Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)),
            Eigen::VectorXd(Eigen::VectorXd::Zero(2)));
}

struct Known {
  Trend trend;
  std::vector<FeatureSpec> features;
};

// Bernstein coefficients that the fit can find: elastic 0.3, 2, 1, 0, 4, 6 N.
Known known_trend(double time_s) {
  Known known;
  known.trend.reference_depth_m = kDepth_m;
  const double elastic[] = {0.3, 2.0, 1.0, 0.0, 4.0, 6.0};
  for (std::size_t k = 0; k < kElasticCoefficients; ++k) {
    const auto power = bernstein_integral<5>(k);
    for (std::size_t j = 0; j < power.size(); ++j) known.trend.elastic_N[j] += elastic[k] * power[j];
  }
  known.trend.viscosity_Ns_per_m = {1.0, 2.0, 1.0};   // 1 + 2 u + u^2: Bernstein 1, 2, 4
  known.trend.thinning_Ns_per_m = {2.0, 0.0, 0.0};
  known.trend.thinning_velocity_m_per_s = kThinning_m_per_s;
  known.trend.velocity_limit_m_per_s = 1.0;
  const double branch[] = {1.0, 0.5, 2.0};
  known.features = {{}, {FeatureKind::velocity, 0.0, {}}};
  if (time_s > 0.0) known.features.push_back({FeatureKind::maxwell_branch, time_s, combined_drive(branch, kDepth_m)});
  return known;
}

// Strokes of many speeds and depths, 20 s at 500 Hz; forces never negative when
// `one_sided`, as a block measures them.
TrendRows rows_of(const Known& known, double time_s, bool one_sided) {
  TrendRows rows(kDepth_m, kThinning_m_per_s, time_s > 0.0 ? std::vector<double>{time_s} : std::vector<double>{});
  rows.begin_recording();
  FeatureFilter filter(known.features);
  for (int i = 0; i < 10000; ++i) {
    const double t = 2e-3 * i;
    const double phase = 2.0 * std::numbers::pi * (0.4 * t + 0.06 * t * t);
    const double amplitude_m = kDepth_m * (0.6 + 0.4 * std::sin(0.9 * t));
    const double position_m = amplitude_m * std::sin(phase);
    const double velocity_m_per_s = amplitude_m * std::cos(phase) * 2.0 * std::numbers::pi * (0.4 + 0.12 * t) +
                                    kDepth_m * 0.36 * std::cos(0.9 * t) * std::sin(phase);
    const ToolSample sample{t, position_m, 0.0, 0.0};
    const MotionEstimate motion{position_m, velocity_m_per_s};
    const FeatureVector& x = filter.update(sample, motion);
    const double force_N = known.trend.at(x.values.data(), known.features);
    rows.add(sample, motion, one_sided ? std::max(0.0, force_N) : force_N, i / 500);
  }
  return rows;
}

// What the trends say, not their coefficients: the bases overlap.
double worst_difference(const TrendRows& rows, const Known& known, const FittedTrend& fitted, bool only_pushing) {
  double worst_N = 0.0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    const double x[] = {rows.depth_m(i), rows.velocity_m_per_s(i)};
    const std::vector<FeatureSpec> specs{{}, {FeatureKind::velocity, 0.0, {}}};
    const double expected_N = known.trend.at(x, specs);
    if (only_pushing && expected_N < 0.05) continue;
    worst_N = std::max(worst_N, std::abs(fitted.trend.at(x, specs) - expected_N));
  }
  return worst_N;
}

// Noise-free data of the trend's own form; the ridge leaves about 1e-4 N.
TEST(FitTrend, RecoversAKnownTrend) {
  for (const double time_s : {0.0, 0.4}) {
    const Known known = known_trend(time_s);
    const TrendRows rows = rows_of(known, time_s, false);
    const FittedTrend fitted = fit_trend(rows, Weighting::jnd, {}, -100.0);
    EXPECT_LT(worst_difference(rows, known, fitted, false), 2e-3) << time_s;
    EXPECT_LT(fitted.weighted_rms, 2e-3);
    EXPECT_GE(fitted.trend.velocity_limit_m_per_s, 0.0);
    EXPECT_EQ(fitted.trend.reference_depth_m, kDepth_m);
    ASSERT_EQ(fitted.branches.size(), time_s > 0.0 ? 1u : 0u);
    if (time_s > 0.0) {
      for (const double u : {0.3, 1.0}) {
        const double expected_N = known.features[2].drive.at(u * kDepth_m);
        EXPECT_NEAR(fitted.branches[0].drive.at(u * kDepth_m), expected_N, 5e-3);
      }
    }
  }
}

// A drive that is a straight line is found either way; a bent one needs the first.
TEST(FitTrend, DrivenByVelocityEveryBranchIsALowPass) {
  const Known known = known_trend(0.4);
  const TrendRows rows = rows_of(known, 0.4, false);
  const FittedTrend fitted = fit_trend(rows, Weighting::jnd, {}, -100.0, BranchDrive::velocity);
  ASSERT_EQ(fitted.branches.size(), 1u);
  const DriveCurve& drive = fitted.branches[0].drive;
  EXPECT_GT(drive.at(kDepth_m), 0.0);
  EXPECT_NEAR(drive.at(0.5 * kDepth_m), 0.5 * drive.at(kDepth_m), 1e-12 * drive.at(kDepth_m));
  EXPECT_LT(fit_trend(rows, Weighting::jnd, {}, -100.0).weighted_rms, fitted.weighted_rms);
}

TEST(FitTrend, OneSidedSamplesDoNotBendIt) {
  const Known known = known_trend(0.0);
  const TrendRows rows = rows_of(known, 0.0, true);
  std::size_t zeros = 0;
  for (std::size_t i = 0; i < rows.count(); ++i) zeros += rows.force_N(i) == 0.0 ? 1 : 0;
  ASSERT_GT(zeros, rows.count() / 20) << "the recording must contain what it is about";
  const FittedTrend fitted = fit_trend(rows, Weighting::jnd, {}, 0.0);
  EXPECT_LT(worst_difference(rows, known, fitted, true), 5e-3);
  // Taken as forces of 0 they would.
  const FittedTrend bent = fit_trend(rows, Weighting::jnd, {}, -100.0);
  EXPECT_GT(worst_difference(rows, known, bent, true), 0.03);
}

// Forces that fall with depth and speed: the nearest trend that makes no energy
// has no negative coefficient, so it rises wherever it is asked.
TEST(FitTrend, NeverFallsWithDepthNorPullsWithSpeed) {
  TrendRows rows(kDepth_m, kThinning_m_per_s, {0.2});
  rows.begin_recording();
  for (int i = 0; i < 2000; ++i) {
    const double position_m = kDepth_m * (0.5 + 0.5 * std::sin(0.01 * i));
    const double velocity_m_per_s = kDepth_m * 5.0 * std::cos(0.01 * i);
    const double force_N = 2.0 - 1.5 * position_m / kDepth_m - 20.0 * velocity_m_per_s;
    rows.add({1e-3 * i, position_m, 0.0, 0.0}, {position_m, velocity_m_per_s}, force_N, 0);
  }
  for (const Weighting weighting : {Weighting::jnd, Weighting::relative, Weighting::none}) {
    const FittedTrend fitted = fit_trend(rows, weighting, {}, 0.01);
    const std::vector<FeatureSpec> specs{{}, {FeatureKind::velocity, 0.0, {}}};
    double last_N = 0.0;
    for (double u = 0.0; u <= 2.0; u += 0.01) {
      const double still[] = {u * kDepth_m, 0.0};
      const double moving[] = {u * kDepth_m, 0.01};
      const double force_N = fitted.trend.at(still, specs);
      EXPECT_GE(force_N, last_N - 1e-12);  // rounding of the powers
      EXPECT_GE(fitted.trend.at(moving, specs), force_N - 1e-12);
      last_N = force_N;
    }
    EXPECT_GE(fitted.branches[0].drive.at(kDepth_m), -1e-12);
  }
}

TEST(FitTrend, NoForceAtAllGivesNoForce) {
  TrendRows rows(kDepth_m, kThinning_m_per_s, {0.2});
  rows.begin_recording();
  for (int i = 0; i < 100; ++i) rows.add({1e-3 * i, 1e-3, 0.0, 0.0}, {1e-3, 0.0}, 0.0, 0);
  const FittedTrend fitted = fit_trend(rows, Weighting::jnd, {}, 0.01);
  const double x[] = {2e-3, 0.1};
  EXPECT_EQ(fitted.trend.at(x, {{}, {FeatureKind::velocity, 0.0, {}}}), 0.0);
  EXPECT_TRUE(std::isfinite(fitted.weighted_rms));
}

}  // namespace
}  // namespace palpate
