#include "models/model/domain_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

double nearest(const Eigen::MatrixXd& points, const Eigen::VectorXd& x) {
  return (points.colwise() - x).colwise().norm().minCoeff();
}

TEST(DomainGuard, EverySiteIsCoveredAndTrusted) {
  for (const int dimension : {1, 2, 4, 8}) {
    for (const int count : {1, 50, 4000}) {
      const Eigen::MatrixXd sites = test::random_points(dimension, count, 3);
      const DomainCover cover = make_cover(sites);
      ASSERT_LE(cover.points.cols(), kMaximumCoverPoints);
      ASSERT_GT(cover.outer_radius, cover.inner_radius);
      const DomainGuard guard(cover);
      for (Eigen::Index i = 0; i < sites.cols(); ++i) {
        ASSERT_LE(nearest(cover.points, sites.col(i)), cover.inner_radius);
        ASSERT_EQ(guard.trust(sites.col(i).data()), 1.0) << dimension << "-D, site " << i << " of " << count;
      }
    }
  }
}

// Sites near a point of the cover are left out, wherever that point is in its block.
TEST(DomainGuard, NoTwoPointsOfACoverAreNearEachOther) {
  for (const int dimension : {1, 2, 4, 8}) {
    const DomainCover cover = make_cover(test::random_points(dimension, 4000, 3));
    // The inner radius is 1.5 times the radius of the cover, at least 0.08; the latter is at least 0.03.
    const double radius = cover.inner_radius > 0.08 ? cover.inner_radius / 1.5 : 0.03;
    for (Eigen::Index i = 1; i < cover.points.cols(); ++i) {
      const Eigen::MatrixXd earlier = cover.points.leftCols(i);
      ASSERT_GT(nearest(earlier, cover.points.col(i)), radius * (1.0 - 1e-12)) << dimension << "-D, point " << i;
    }
  }
}

TEST(DomainGuard, FarAwayThereIsNoTrust) {
  const Eigen::MatrixXd sites = test::random_points(3, 500, 4);
  const DomainGuard guard(make_cover(sites));
  for (const double far : {10.0, 1e6, 1e300}) {
    EXPECT_EQ(guard.trust(Eigen::Vector3d(far, -far, 0.0).eval().data()), 0.0);
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(guard.trust(Eigen::Vector3d(0.0, bad, 0.0).eval().data()), 0.0);
  }
}

// g(distance): the smoothstep of the header, around a single site. The guard
// measures distances in single precision: 6e-8 of 0.3 at a slope below 10.
TEST(DomainGuard, IsTheSmoothstepBetweenTheRadii) {
  const DomainCover cover = make_cover(Eigen::MatrixXd::Zero(2, 1));
  const DomainGuard guard(cover);
  for (double r = 0.0; r < 1.5 * cover.outer_radius; r += 0.001) {
    const double t = std::clamp((cover.outer_radius - r) / (cover.outer_radius - cover.inner_radius), 0.0, 1.0);
    EXPECT_NEAR(guard.trust(Eigen::Vector2d(0.6 * r, 0.8 * r).eval().data()), t * t * (3.0 - 2.0 * t), 1e-6);
  }
}

TEST(DomainGuard, IdenticalSitesMakeOnePoint) { EXPECT_EQ(make_cover(Eigen::MatrixXd::Ones(4, 300)).points.cols(), 1); }

}  // namespace
}  // namespace palpate
