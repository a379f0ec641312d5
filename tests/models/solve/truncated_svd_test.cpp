#include "models/solve/truncated_svd.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/model/rbf/rbf_evaluate.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

Sites example_sites(int count) {
  Sites sites = test::smooth_sites(2, count, 0.0, 3);
  sites.row_scale = sites.target_N.cwiseInverse();
  sites.as_2009 = true;
  return sites;
}

double largest_error(const Sites& sites, const RbfFunction& function) {
  Eigen::VectorXd values;
  RbfCorrection(function).evaluate_many(sites.points, values);
  return (values - sites.target_N).cwiseAbs().maxCoeff();
}

TEST(TruncatedSvd, InterpolatesEverySite) {
  const Sites sites = example_sites(150);
  const auto fitted = truncated_interpolant(sites, KernelKind::cubic, {});
  ASSERT_TRUE(fitted.ok()) << fitted.error().message;
  EXPECT_LT(largest_error(sites, fitted->function), 1e-8);
  // The side condition, eq. 3.
  EXPECT_LT(std::abs(fitted->function.weights.sum()), 1e-6 * fitted->function.weights.cwiseAbs().sum());
}

TEST(TruncatedSvd, CentresAtOnePointShareTheWeight) {
  const Sites sites = example_sites(300);
  Eigen::MatrixXd centres = sites.points.leftCols(40);
  centres.col(39) = centres.col(0);
  const auto fitted = solve_weights(sites, KernelKind::cubic, centres);
  const auto once = solve_weights(sites, KernelKind::cubic, centres.leftCols(39));
  ASSERT_TRUE(fitted.ok() && once.ok());
  const Eigen::VectorXd& weights = fitted->function.weights;
  EXPECT_NEAR(weights(0), weights(39), 1e-6 * weights.cwiseAbs().maxCoeff());
  // The same least squares error as without the duplicate.
  EXPECT_NEAR(largest_error(sites, fitted->function), largest_error(sites, once->function), 1e-6);
}

}  // namespace
}  // namespace palpate
