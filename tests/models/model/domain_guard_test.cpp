#include "models/model/fitted_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "engine/tick/features.h"
#include "models/model/vector_loops.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_points;

double nearest(const Eigen::MatrixXd& points, const Eigen::VectorXd& x) {
  return (points.colwise() - x).colwise().norm().minCoeff();
}

TEST(DomainGuard, EverySiteIsCoveredAndTrusted) {
  for (const int dimension : {1, 2, 4, 8}) {
    for (const int count : {1, 50, 4000}) {
      const Eigen::MatrixXd sites = random_points(dimension, count, 3);
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
    const DomainCover cover = make_cover(random_points(dimension, 4000, 3));
    // The inner radius is 1.5 times the radius of the cover, at least 0.08; the latter is at least 0.03.
    const double radius = cover.inner_radius > 0.08 ? cover.inner_radius / 1.5 : 0.03;
    for (Eigen::Index i = 1; i < cover.points.cols(); ++i) {
      const Eigen::MatrixXd earlier = cover.points.leftCols(i);
      ASSERT_GT(nearest(earlier, cover.points.col(i)), radius * (1.0 - 1e-12)) << dimension << "-D, point " << i;
    }
  }
}

TEST(DomainGuard, FarAwayThereIsNoTrust) {
  const Eigen::MatrixXd sites = random_points(3, 500, 4);
  const DomainGuard guard(make_cover(sites));
  for (const double far : {10.0, 1e6, 1e300}) {
    EXPECT_EQ(guard.trust(Eigen::Vector3d(far, -far, 0.0).eval().data()), 0.0);
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(guard.trust(Eigen::Vector3d(0.0, bad, 0.0).eval().data()), 0.0);
  }
}

class NearestPointsOnTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { simd::use_target(GetParam()); }
  void TearDown() override { simd::use_target(0); }
};

TEST_P(NearestPointsOnTarget, TheDistanceIsThatOfABruteForceSearch) {
  for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d)
    for (const int count : {1, 31, 32, 33, 200, 768, 5000}) {
      const Eigen::MatrixXd points = random_points(d, count, 1);
      const NearestDistance distance(points);
      const Eigen::MatrixXd queries = random_points(d, 20, 9);
      for (int i = 0; i < 20; ++i) {
        const double scale = queries.col(i).norm() + points.colwise().norm().maxCoeff();
        EXPECT_NEAR(std::sqrt(distance.squared(queries.col(i).data())), nearest(points, queries.col(i)),
                    3e-7 * scale + 1e-10);
      }
    }
}

// The cell of the last query is examined first. A force must not depend on that, to the last bit, also far from the
// origin, where single precision has few digits; nor on whether a search ended at a point that was near enough.
TEST_P(NearestPointsOnTarget, AResultDoesNotDependOnTheQueriesBefore) {
  for (const int d : {1, 3, 8})
    for (const double shift : {0.0, 300.0}) {
      const Eigen::MatrixXd points = random_points(d, 768, 1).array() + shift;
      const Eigen::MatrixXd queries = random_points(d, 200, 9).array() + shift;
      const NearestDistance used(points), near(points);
      for (int i = 0; i < 200; ++i) {
        const double* query = queries.col(i).data();
        const double squared = NearestDistance(points).squared(query);
        EXPECT_EQ(used.squared(query), squared);
        const auto enough = static_cast<float>(squared);
        EXPECT_EQ(near.squared(query, enough), 0.0);
        EXPECT_EQ(near.squared(query, std::nextafter(enough, 0.0F)), squared > 0.0 ? squared : 0.0);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, NearestPointsOnTarget, testing::ValuesIn(simd::all_targets()), [](const auto& instance) {
  simd::use_target(instance.param);
  std::string name = simd::target_name();
  simd::use_target(0);
  return name;
});

}  // namespace
}  // namespace palpate
