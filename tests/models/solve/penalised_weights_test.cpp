#include <gtest/gtest.h>

#include <cmath>

#include "models/fit/fit_direct.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

double between(test::Numbers& numbers, double low, double high) {
  return low + 0.5 * (high - low) * (numbers.next() + 1.0);
}

Sites wavy_sites(Eigen::Index count) {
  Sites sites;
  test::Numbers numbers(7);
  sites.points.resize(2, count);
  sites.target_N.resize(count);
  sites.row_scale.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < 2; ++k) sites.points(k, i) = between(numbers, -1.0, 1.0);
    sites.target_N(i) = std::sin(3.0 * sites.points(0, i)) + 0.5 * sites.points(1, i) + between(numbers, -0.1, 0.1);
    sites.row_scale(i) = between(numbers, 0.5, 2.0);
  }
  return sites;
}

double largest_difference(const RbfFunction& a, const RbfFunction& b, const Sites& sites) {
  const RbfEvaluator one(a);
  const RbfEvaluator other(b);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < sites.count(); ++i) {
    const double* x = sites.points.col(i).data();
    largest = std::max(largest, std::abs(one.evaluate(x) - other.evaluate(x)));
  }
  return largest;
}

FittedRbf penalised(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  auto factorised = factorise_rows(sites, kernel, centres);
  EXPECT_TRUE(factorised.ok());
  factorised->plain_unknowns_limit = 0;
  factorised->smoothing = *sites.smoothing;
  return penalised_weights(*factorised, kernel, centres);
}

TEST(PenaltySpace, ItsColumnsAreOrthogonalToTheTailAndMultiplyInPlace) {
  const Sites sites = wavy_sites(60);
  const PenaltySpace space = penalty_space(KernelKind::cubic, sites.points);
  const Eigen::MatrixXd tail = tail_matrix(tail_degree(KernelKind::cubic), sites.points);
  const Eigen::Index free = space.free;
  EXPECT_EQ(free, sites.count() - tail.cols());
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(60, 60);
  multiply_by_basis(all, space);
  const Eigen::MatrixXd basis = all.leftCols(free);
  EXPECT_LT((basis.transpose() * tail).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((basis.transpose() * basis - Eigen::MatrixXd::Identity(free, free)).cwiseAbs().maxCoeff(), 1e-13);
  const Eigen::MatrixXd matrix = test::random_points(37, 60, 5);
  Eigen::MatrixXd product = matrix;
  multiply_by_basis(product, space);
  EXPECT_LT((product.leftCols(free) - matrix * basis).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(PenalisedWeights, WithEverySiteACentreItIsTheSmoothingSpline) {
  Sites sites = wavy_sites(120);
  for (const KernelKind kernel : {KernelKind::cubic, KernelKind::linear, KernelKind::thin_plate}) {
    for (const double smoothing : {1e-2, 1.0}) {
      sites.smoothing = smoothing;
      const auto some = penalised(sites, kernel, sites.points);
      const auto all = fit_direct(sites, kernel, smoothing);
      ASSERT_TRUE(all.ok());
      // Two algorithms for systems with condition numbers up to some 1e6.
      EXPECT_LT(largest_difference(some.function, all->function, sites), 1e-7) << kernel_name(kernel);
    }
  }
}

TEST(PenalisedWeights, MuchSmoothingLeavesTheTail) {
  Sites sites = wavy_sites(200);
  sites.smoothing = 1e12;
  const auto fitted = penalised(sites, KernelKind::cubic, sites.points.leftCols(30));
  EXPECT_LT(fitted.function.weights.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PenalisedWeights, TheStrengthMultipliesTheFunction) {
  Sites sites = wavy_sites(150);
  sites.smoothing = 0.1;
  const auto full = penalised(sites, KernelKind::cubic, sites.points.leftCols(20));
  sites.strength = 0.25;
  const auto quarter = penalised(sites, KernelKind::cubic, sites.points.leftCols(20));
  EXPECT_LT((0.25 * full.function.weights - quarter.function.weights).norm(), 1e-12);
  EXPECT_LT((0.25 * full.function.tail - quarter.function.tail).norm(), 1e-12);
}

TEST(PenalisedWeights, WeightsAreOrthogonalToTheTail) {
  Sites sites = wavy_sites(150);
  sites.smoothing = 0.01;
  const auto fitted = penalised(sites, KernelKind::cubic, sites.points.leftCols(40));
  const Eigen::VectorXd& w = fitted.function.weights;
  EXPECT_LT(std::abs(w.sum()), 1e-9 * w.cwiseAbs().sum());
  EXPECT_LT((fitted.function.centres * w).norm(), 1e-9 * w.cwiseAbs().sum());
}

}  // namespace
}  // namespace palpate
