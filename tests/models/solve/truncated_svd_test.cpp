#include "models/solve/truncated_svd.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {
namespace {

// A smooth function of two variables at random points.
Sites example_sites(Eigen::Index count) {
  RandomStream random(3, 0);
  Sites sites;
  sites.points.resize(2, count);
  sites.target_N.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    sites.points.col(i) << random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0);
    sites.target_N(i) = 2.0 + std::sin(2.0 * sites.points(0, i)) * std::cos(sites.points(1, i));
  }
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
