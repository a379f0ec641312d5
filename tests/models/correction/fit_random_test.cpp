#include <gtest/gtest.h>

#include "tests/support/fit_centres.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::fit_random;
using test::smooth_sites;

TEST(FitRandom, CentresAreDistinctSitesThatDependOnTheSeed) {
  Sites sites = smooth_sites(3, 60, 0.0, 1);
  sites.points.rightCols(30) = sites.points.leftCols(30);
  const auto fitted = fit_random(sites, {.centres = 30});
  ASSERT_TRUE(fitted.ok());
  const Eigen::MatrixXd& centres = fitted->centres;
  for (int j = 0; j < 30; ++j) {
    EXPECT_EQ((sites.points.colwise() - centres.col(j)).colwise().norm().minCoeff(), 0.0);
    for (int k = 0; k < j; ++k) EXPECT_GT((centres.col(j) - centres.col(k)).norm(), 0.0);
  }
  EXPECT_NE(centres, fit_random(sites, {.centres = 30, .seed = 6})->centres);
}

TEST(FitRandom, IdenticalSitesGiveTheirWeightedMean) {
  Sites sites = smooth_sites(2, 4, 0.0, 1);
  sites.points.colwise() = sites.points.col(0).eval();
  sites.target_N << 1, 2, 3, 6;
  sites.row_scale.setOnes();
  const auto fitted = fit_random(sites, {});
  ASSERT_TRUE(fitted.ok());
  // The ridge may reduce the force by a relative 1e-5 with four sites.
  EXPECT_NEAR(rbf_value(*fitted, sites.points.data()), 3.0, 1e-4);
}

}  // namespace
}  // namespace palpate
