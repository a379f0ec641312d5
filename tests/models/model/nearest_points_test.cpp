#include "models/model/nearest_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "engine/tick/features.h"
#include "models/model/rbf/rbf_simd.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_points;

bool is_near(const NearPoints& points, const double* x) { return points.found(x, points.leaf(x)); }

class NearestPointsOnTarget : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_TRUE(simd::choose_target(GetParam())); }
  void TearDown() override { simd::choose_target(""); }
};

TEST_P(NearestPointsOnTarget, TheDistanceIsThatOfABruteForceSearch) {
  for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d)
    for (const int count : {1, 15, 16, 17, 200}) {
      const Eigen::MatrixXd points = random_points(d, count, 1);
      const NearestDistance nearest(points);
      const Eigen::MatrixXd queries = random_points(d, 20, 9);
      for (int i = 0; i < 20; ++i) {
        const double expected = (points.colwise() - queries.col(i)).colwise().norm().minCoeff();
        const double scale = queries.col(i).norm() + points.colwise().norm().maxCoeff();
        EXPECT_NEAR(std::sqrt(nearest.nearest_squared(queries.col(i).data())), expected, 3e-7 * scale + 1e-10);
      }
    }
}

// Must be exact, because a force must not depend on the algorithm that found its trust. Also far
// from the origin, where single precision has few digits.
TEST_P(NearestPointsOnTarget, OneFoundNearIsNoFurther) {
  for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d)
    for (const int count : {1, 2, 16, 63, 65, 500, 768, 5000})
      for (const double shift : {0.0, 300.0}) {
        const Eigen::MatrixXd points = random_points(d, count, 1).array() + shift;
        const NearestDistance nearest(points);
        const Eigen::MatrixXd queries = random_points(d, 4, 9).array() + shift;
        for (int i = 0; i < 4; ++i) {
          const double* query = queries.col(i).data();
          const double exact = std::sqrt(nearest.nearest_squared(query));
          for (const double radius : {0.0, 0.5 * exact, 0.999999 * exact})
            EXPECT_FALSE(is_near(NearPoints(points, radius), query)) << d << "-D, " << count << " points";
          EXPECT_TRUE(is_near(NearPoints(points, 100.0), query)) << d << "-D, " << count << " points";
        }
      }
}

// Leaves overlap, so that few queries have their near points only in another leaf.
TEST_P(NearestPointsOnTarget, HardlyOneThatIsNearIsMissed) {
  const double radius = 0.3;
  const Eigen::MatrixXd points = random_points(3, 768, 1);
  const NearestDistance nearest(points);
  const NearPoints near(points, radius);
  const Eigen::MatrixXd queries = random_points(3, 5000, 9);
  int inside = 0;
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    inside += nearest.nearest_squared(queries.col(i).data()) <= radius * radius ? 1 : 0;
    found += is_near(near, queries.col(i).data()) ? 1 : 0;
  }
  EXPECT_GT(inside, 4000);
  EXPECT_LE(found, inside);
  EXPECT_GT(found, inside - inside / 20);
}

TEST_P(NearestPointsOnTarget, NothingIsNearFarAwayOrToWhatIsNoNumber) {
  const Eigen::MatrixXd points = random_points(2, 5, 1);
  const NearestDistance nearest(points);
  const NearPoints near(points, 1e15);
  const double infinity = std::numeric_limits<double>::infinity();
  const double bad[][2] = {{1e30, 0}, {infinity, 0}, {0, std::numeric_limits<double>::quiet_NaN()}};
  for (const auto& x : bad) {
    EXPECT_EQ(nearest.nearest_squared(x), infinity);
    EXPECT_FALSE(is_near(near, x));
  }
}

INSTANTIATE_TEST_SUITE_P(All, NearestPointsOnTarget, testing::ValuesIn(simd::target_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace palpate
