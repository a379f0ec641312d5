#include "models/solve/solve_weights.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "models/fit/fit_direct.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_points;
using test::smooth_sites;

Eigen::MatrixXd naive_matrix(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  Eigen::MatrixXd matrix(sites.count(), centres.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      matrix(i, j) = kernel_value(kernel, (sites.points.col(i) - centres.col(j)).norm());
  Eigen::MatrixXd whole(sites.count(), matrix.cols() + tail_size(tail_degree(kernel), sites.dimension()));
  whole << matrix, tail_matrix(tail_degree(kernel), sites.points);
  return whole.array().colwise() * sites.row_scale.array();
}

double worst_error(const RbfFunction& function, const Sites& sites) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < sites.count(); ++i)
    worst = std::max(worst, std::abs(rbf_value(function, sites.points.col(i).data()) - sites.target_N[i]));
  return worst;
}

TEST(SolveWeights, ReproducesAPolynomialOfTheTailExactly) {
  for (const KernelKind kernel : kKernelKinds) {
    Sites sites = smooth_sites(2, 200, 0.0, 1);
    const Eigen::VectorXd tail = random_points(1, tail_size(tail_degree(kernel), 2), 3).transpose();
    sites.target_N = tail_matrix(tail_degree(kernel), sites.points) * tail;
    const Result<FittedRbf> fitted = solve_weights(sites, kernel, sites.points.leftCols(20));
    ASSERT_TRUE(fitted.ok());
    EXPECT_LE((fitted->function.tail - tail).cwiseAbs().maxCoeff(), 1e-10) << kernel_name(kernel);
    EXPECT_LE(fitted->function.weights.cwiseAbs().maxCoeff(), 1e-10);
  }
}

// With as few sites as unknowns, signal and noise cannot be separated reliably.
TEST(SolveWeights, FollowsAsManySitesAsUnknownsToWithinTheSmoothing) {
  const Sites sites = smooth_sites(3, 40, 0.0, 2);
  const Result<FittedRbf> fitted = solve_weights(sites, KernelKind::cubic, sites.points);
  ASSERT_TRUE(fitted.ok());
  EXPECT_LE(worst_error(fitted->function, sites), 0.1);
}

TEST(SolveWeights, CoincidingCentresShareTheirWeight) {
  const Sites sites = smooth_sites(2, 300, 0.0, 2);
  Eigen::MatrixXd centres(2, 16);
  centres << sites.points.leftCols(8), sites.points.leftCols(8);
  const Result<FittedRbf> fitted = solve_weights(sites, KernelKind::cubic, centres);
  ASSERT_TRUE(fitted.ok());
  const auto alone = solve_weights(sites, KernelKind::cubic, sites.points.leftCols(8));
  ASSERT_TRUE(alone.ok());
  const auto& weights = fitted->function.weights;
  EXPECT_LT(weights.cwiseAbs().maxCoeff(), 2.0 * alone->function.weights.cwiseAbs().maxCoeff());
  EXPECT_LT((weights.head(8) - weights.tail(8)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((weights.head(8) + weights.tail(8) - alone->function.weights).cwiseAbs().maxCoeff(), 1e-6);
}

// Forty clusters of six sites each, 1e-6 apart: the data determine 40 of 44
// unknowns. Least squares fits the noise in a cluster with slopes of 1e4.
TEST(SolveWeights, TheLikelihoodKeepsNoiseOutOfUnknownsThatTheDataDoNotTell) {
  Sites sites = smooth_sites(3, 240, 0.01, 1);
  const Sites base = smooth_sites(3, 40, 0.0, 1);
  for (Eigen::Index i = 0; i < 240; ++i) {
    sites.points.col(i) = base.points.col(i % 40) + 1e-6 * sites.points.col(i);
    sites.target_N[i] = base.target_N[i % 40] + 0.01 * std::sin(1e3 * static_cast<double>(i));
  }
  const Sites truth = smooth_sites(3, 200, 0.0, 99);
  const Eigen::MatrixXd matrix = naive_matrix(sites, KernelKind::cubic, base.points);
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  const Eigen::VectorXd plain = matrix.bdcSvd(Eigen::ComputeThinU | Eigen::ComputeThinV).solve(data);
  const RbfFunction least_squares{KernelKind::cubic, base.points, plain.head(40), plain.tail(4)};
  const auto likely = solve_weights(sites, KernelKind::cubic, base.points);
  ASSERT_TRUE(likely.ok());
  EXPECT_GT(worst_error(least_squares, truth), 100.0);
  EXPECT_LT(worst_error(likely->function, truth), 2.0);  // 40 clusters in a cube, with forces up to 5 N
  EXPECT_GT(likely->report.smoothing, 0.0);
  EXPECT_LT(likely->report.residual_rms, 1.1 * (matrix * plain - data).norm() / std::sqrt(240.0));
}

// Many sites determine all unknowns: least squares without the side condition.
TEST(SolveWeights, ManySitesAreLeftAlone) {
  const Sites sites = smooth_sites(3, 2000, 0.001, 1);
  const Eigen::MatrixXd centres = sites.points.leftCols(100);
  const auto likely = solve_weights(sites, KernelKind::cubic, centres);
  auto factorised = factorise_rows(sites, KernelKind::cubic, centres);
  ASSERT_TRUE(likely.ok() && factorised.ok());
  factorised->plain_unknowns_limit = 0;
  factorised->smoothing = 0.0;
  const FittedRbf plain = penalised_weights(*factorised, KernelKind::cubic, centres);
  EXPECT_LT(likely->report.residual_rms, plain.report.residual_rms);
}

TEST(SolveWeights, OneSiteGivesItsForce) {
  const Sites sites = smooth_sites(4, 1, 0.0, 2);
  const Result<FittedRbf> fitted = solve_weights(sites, KernelKind::cubic, sites.points);
  ASSERT_TRUE(fitted.ok());
  EXPECT_NEAR(rbf_value(fitted->function, sites.points.data()), sites.target_N[0], 1e-13);
}

TEST(SolveWeights, ZeroForcesGiveAZeroFunction) {
  Sites sites = smooth_sites(4, 100, 0.0, 2);
  sites.target_N.setZero();
  const Result<FittedRbf> fitted = solve_weights(sites, KernelKind::cubic, sites.points.leftCols(10));
  ASSERT_TRUE(fitted.ok());
  EXPECT_EQ(fitted->function.weights.norm(), 0.0);
  EXPECT_EQ(fitted->function.tail.norm(), 0.0);
}

TEST(SolveWeights, ASiteWithScaleZeroDoesNotCount) {
  Sites sites = smooth_sites(2, 200, 0.0, 2);
  const Result<FittedRbf> before = solve_weights(sites, KernelKind::cubic, sites.points.leftCols(10));
  sites.row_scale[150] = 0.0;
  const Result<FittedRbf> without = solve_weights(sites, KernelKind::cubic, sites.points.leftCols(10));
  sites.target_N[150] = 1e6;
  const Result<FittedRbf> wild = solve_weights(sites, KernelKind::cubic, sites.points.leftCols(10));
  ASSERT_TRUE(before.ok() && without.ok() && wild.ok());
  EXPECT_EQ(without->function.weights, wild->function.weights);
}

FittedRbf penalised(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  auto factorised = factorise_rows(sites, kernel, centres);
  EXPECT_TRUE(factorised.ok());
  factorised->plain_unknowns_limit = 0;
  factorised->smoothing = *sites.smoothing;
  return penalised_weights(*factorised, kernel, centres);
}

TEST(PenaltySpace, ItsColumnsAreOrthogonalToTheTailAndMultiplyInPlace) {
  const Sites sites = smooth_sites(2, 60, 0.1, 7);
  const PenaltySpace space = penalty_space(KernelKind::cubic, sites.points);
  const Eigen::MatrixXd tail = tail_matrix(tail_degree(KernelKind::cubic), sites.points);
  const Eigen::Index free = space.free;
  EXPECT_EQ(free, sites.count() - tail.cols());
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(60, 60);
  multiply_by_basis(all, space);
  const Eigen::MatrixXd basis = all.leftCols(free);
  EXPECT_LT((basis.transpose() * tail).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((basis.transpose() * basis - Eigen::MatrixXd::Identity(free, free)).cwiseAbs().maxCoeff(), 1e-13);
  const Eigen::MatrixXd matrix = random_points(37, 60, 5);
  Eigen::MatrixXd product = matrix;
  multiply_by_basis(product, space);
  EXPECT_LT((product.leftCols(free) - matrix * basis).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(PenalisedWeights, WithEverySiteACentreItIsTheSmoothingSpline) {
  Sites sites = smooth_sites(2, 120, 0.1, 7);
  for (const KernelKind kernel : {KernelKind::cubic, KernelKind::linear, KernelKind::thin_plate}) {
    for (const double smoothing : {1e-2, 1.0}) {
      sites.smoothing = smoothing;
      const auto some = penalised(sites, kernel, sites.points);
      const auto all = fit_direct(sites, kernel, smoothing);
      ASSERT_TRUE(all.ok());
      // Two algorithms for systems with condition numbers up to some 1e6.
      EXPECT_LT(test::largest_difference(some.function, all->function, sites.points), 1e-7) << kernel_name(kernel);
    }
  }
}

TEST(PenalisedWeights, MuchSmoothingLeavesTheTail) {
  Sites sites = smooth_sites(2, 200, 0.1, 7);
  sites.smoothing = 1e14;
  const auto fitted = penalised(sites, KernelKind::cubic, sites.points.leftCols(30));
  EXPECT_LT(fitted.function.weights.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PenalisedWeights, TheStrengthMultipliesTheFunction) {
  Sites sites = smooth_sites(2, 150, 0.1, 7);
  sites.smoothing = 0.1;
  const auto full = penalised(sites, KernelKind::cubic, sites.points.leftCols(20));
  sites.strength = 0.25;
  const auto quarter = penalised(sites, KernelKind::cubic, sites.points.leftCols(20));
  EXPECT_LT((0.25 * full.function.weights - quarter.function.weights).norm(), 1e-12);
  EXPECT_LT((0.25 * full.function.tail - quarter.function.tail).norm(), 1e-12);
}

TEST(DistinctSites, KeepsTheFirstOfEachPoint) {
  Sites sites;
  sites.points.resize(2, 5);
  sites.points << 1, 0, 1, 0, 2,  //
      3, 5, 3, 4, 0;
  EXPECT_EQ(distinct_sites(sites), (std::vector<Eigen::Index>{0, 1, 3, 4}));
}

}  // namespace
}  // namespace palpate
