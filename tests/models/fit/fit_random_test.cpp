#include "models/fit/choose_centres.h"

#include <gtest/gtest.h>

#include "tests/support/fit_centres.h"
#include "tests/support/message_parts.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::fit_random;
using test::smooth_sites;

bool same_function(const RbfFunction& a, const RbfFunction& b) {
  return a.centres == b.centres && a.weights == b.weights && a.tail == b.tail;
}

TEST(FitRandom, SameSeedSameBitsAnotherSeedOtherCentres) {
  const Sites sites = smooth_sites(4, 3000, 0.01, 1);
  const auto first = fit_random(sites, {.centres = 40, .seed = 5});
  const auto again = fit_random(sites, {.centres = 40, .seed = 5});
  const auto other = fit_random(sites, {.centres = 40, .seed = 6});
  ASSERT_TRUE(first.ok() && again.ok() && other.ok());
  EXPECT_TRUE(same_function(first->function, again->function));
  EXPECT_NE(first->function.centres, other->function.centres);
}

TEST(FitRandom, CentresAreDistinctSites) {
  Sites sites = smooth_sites(3, 60, 0.0, 1);
  sites.points.rightCols(30) = sites.points.leftCols(30);
  const auto fitted = fit_random(sites, {.centres = 30});
  ASSERT_TRUE(fitted.ok());
  const Eigen::MatrixXd& centres = fitted->function.centres;
  for (int j = 0; j < 30; ++j) {
    EXPECT_EQ((sites.points.colwise() - centres.col(j)).colwise().norm().minCoeff(), 0.0);
    for (int k = 0; k < j; ++k) EXPECT_GT((centres.col(j) - centres.col(k)).norm(), 0.0);
  }
}

TEST(FitRandom, MoreCentresThanSitesAreCutAndNoted) {
  const Sites sites = smooth_sites(2, 12, 0.0, 1);
  const auto fitted = fit_random(sites, {.centres = 100});
  ASSERT_TRUE(fitted.ok());
  EXPECT_EQ(fitted->report.centres_used, 12);
  EXPECT_TRUE(test::has_parts(fitted->report.notes.back(), {"12 centres"}));
}

TEST(FitRandom, IdenticalSitesGiveTheirWeightedMean) {
  Sites sites = smooth_sites(2, 4, 0.0, 1);
  sites.points.colwise() = sites.points.col(0).eval();
  sites.target_N << 1, 2, 3, 6;
  sites.row_scale.setOnes();
  const auto fitted = fit_random(sites, {});
  ASSERT_TRUE(fitted.ok());
  // The ridge may reduce the force by a relative 1e-5 with four sites.
  EXPECT_NEAR(rbf_value(fitted->function, sites.points.data()), 3.0, 1e-4);
}

}  // namespace
}  // namespace palpate
