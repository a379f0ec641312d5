#include "models/correction/algebra.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "models/correction/methods.h"
#include "models/model/correction.h"
#include "tests/support/message_parts.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_points;
using test::smooth_sites;

Result<RbfFunction> function_of(const Sites& sites) {
  auto solved = solve_direct(sites);
  if (!solved) return solved.error();
  return solved->function();
}

Result<RbfFunction> smoothed_fit(Sites sites, KernelKind kernel, double smoothing) {
  sites.kernel = kernel;
  sites.smoothing = smoothing;
  return function_of(sites);
}

// The system of eq. 4 with the smoothing on its diagonal, by dense LU with
// full pivoting.
RbfFunction saddle_solution(const Sites& sites, KernelKind kernel, double smoothing) {
  const Eigen::Index n = sites.count();
  const Eigen::MatrixXd tail = tail_matrix(tail_degree(kernel), sites.points);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + tail.cols(), n + tail.cols());
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      matrix(i, j) = kernel_value(kernel, (sites.points.col(i) - sites.points.col(j)).norm());
  matrix.topLeftCorner(n, n).diagonal() +=
      definiteness_sign(kernel) * smoothing * sites.row_scale.cwiseAbs2().cwiseInverse();
  matrix.topRightCorner(n, tail.cols()) = tail;
  matrix.bottomLeftCorner(tail.cols(), n) = tail.transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + tail.cols());
  right.head(n) = sites.target_N;
  const Eigen::VectorXd solution = matrix.fullPivLu().solve(right);
  return {kernel, sites.points, solution.head(n), solution.tail(tail.cols())};
}

// The condition number is up to 1e7 here, so nine digits are correct; the test requires eight.
TEST(FitDirect, SolvesTheSaddleSystemOfEquation4) {
  const Sites sites = smooth_sites(3, 120, 0.01, 1);
  for (const KernelKind kernel : kKernelKinds)
    for (const double smoothing : {1e-3, 1e-1, 10.0}) {
      const auto fitted = smoothed_fit(sites, kernel, smoothing);
      ASSERT_TRUE(fitted.ok());
      const RbfFunction expected = saddle_solution(sites, kernel, smoothing);
      const double size = expected.weights.cwiseAbs().maxCoeff();
      EXPECT_LE((fitted->weights - expected.weights).cwiseAbs().maxCoeff(), 1e-8 * size)
          << kernel_name(kernel) << smoothing;
      EXPECT_LE((fitted->tail - expected.tail).cwiseAbs().maxCoeff(), 1e-8 * (1 + size));
    }
}

TEST(FitDirect, SameDataSameBits) {
  const Sites sites = smooth_sites(4, 700, 0.01, 1);
  const auto a = function_of(sites);
  const auto b = function_of(sites);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->weights, b->weights);
  EXPECT_EQ(a->tail, b->tail);
}

TEST(FitDirect, RefusesTooManySitesAndCanBeInterrupted) {
  Sites large;
  large.points = Eigen::MatrixXd::Zero(1, kMostDirectSites + 1);
  large.target_N = large.row_scale = Eigen::VectorXd::Ones(kMostDirectSites + 1);
  EXPECT_TRUE(test::has_parts(solve_direct(large).error().message, {"20001", "too large", "20000", "; "}));
  const Sites sites = smooth_sites(2, 300, 0, 1);
  std::vector<double> asked;
  ASSERT_TRUE(solve_direct(sites, {[&](double f) { return asked.push_back(f), true; }}).ok());
  EXPECT_TRUE(std::is_sorted(asked.begin(), asked.end()));
  EXPECT_EQ(asked.size(), 5u) << "at the start, before and within the factorisation (two blocks), and after it";
  for (const double fraction : asked) {
    const auto stopped = solve_direct(sites, {[&](double f) { return f < fraction; }});
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().message, "interrupted") << fraction;
  }
}

}  // namespace
}  // namespace palpate
