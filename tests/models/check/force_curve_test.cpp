// Differences of the force curves of two recordings, with shapes whose difference is known.
#include "models/check/force_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Ten strokes from 1 to 3 mm. The force is larger during loading by `friction_N` on either side of its mean.
std::vector<RecordingRow> strokes(double shift_m, double friction_N = 0.0, double factor = 1.0) {
  std::vector<RecordingRow> rows;
  for (int i = 0; i < 20000; ++i) {
    const double depth_m = 2e-3 - 1e-3 * std::cos(2e-3 * std::acos(-1.0) * i);
    const double friction = std::sin(2e-3 * std::acos(-1.0) * i) > 0.0 ? friction_N : -friction_N;
    rows.push_back({0.0, depth_m + shift_m, factor * 8e5 * depth_m * depth_m + friction});
  }
  return rows;
}

std::optional<CurveDifference> difference_of(const std::vector<RecordingRow>& first,
                                             const std::vector<RecordingRow>& second, double shift_m = 0.0) {
  const double bin_m = common_bin_m(first, second);
  return difference(ForceCurve(first, bin_m), ForceCurve(second, bin_m), shift_m, JndLine{});
}

TEST(ForceCurve, OfTheSameForcesHasNoDifference) {
  for (const double shift_m : {-1e-3, 0.0, 0.3e-3, 5e-3}) {
    const auto found = difference_of(strokes(0.0, 0.1), strokes(shift_m, 0.1), shift_m);
    ASSERT_TRUE(found) << shift_m;
    // The slope of 4 N/mm at a depth of 2.5 mm times half a bin of 2 mm / 60.
    EXPECT_NEAR(found->median_N, 0.0, 0.07) << shift_m;
    EXPECT_LT(found->median_jnds, 0.5) << shift_m;
    EXPECT_EQ(found->apart_share, 0.0) << shift_m;
  }
}

TEST(ForceCurve, TellsAForceOffset) {
  std::vector<RecordingRow> second = strokes(0.0);
  for (RecordingRow& row : second) row.force_N += 2.0;
  const auto found = difference_of(strokes(0.0), second);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->median_N, 2.0, 1e-9);
  EXPECT_GT(found->median_jnds, 2.0);
  EXPECT_EQ(found->apart_share, 1.0);
}

TEST(ForceCurve, AnotherStiffnessIsApart) {
  const auto found = difference_of(strokes(0.0), strokes(0.0, 0.0, 3.0));
  ASSERT_TRUE(found);
  EXPECT_GT(found->apart_share, 0.9);
  EXPECT_GT(found->median_N, 3.0);  // twice the force at 2 mm is 6.4 N
}

// The medians of loading and unloading differ, those of both together overlap.
TEST(ForceCurve, MoreFrictionIsADifferenceThatIsNotApart) {
  const auto found = difference_of(strokes(0.0), strokes(0.0, 1.0));
  ASSERT_TRUE(found);
  EXPECT_GT(found->median_jnds, 1.0);
  EXPECT_LT(found->apart_share, 0.1);
  const double bin_m = 2e-3 / 60.0;
  const ForceCurve curve(strokes(0.0, 1.0), bin_m);
  const ForceCurve::Bin& middle = curve.bins()[curve.bins().size() / 2];
  ASSERT_TRUE(middle.median_N[0] && middle.median_N[1]);
  EXPECT_NEAR(*middle.median_N[0] - *middle.median_N[1], 2.0, 1e-2);
}

TEST(ForceCurve, ComparesOnlyCurvesThatOverlap) {
  EXPECT_FALSE(difference_of(strokes(0.0), strokes(1.9e-3)));
  EXPECT_TRUE(difference_of(strokes(0.0), strokes(1.9e-3), 1.9e-3));
}

// Presses from 10 mm outside of the material to 3 mm inside, with pseudo-noise of 3 mN.
std::vector<RecordingRow> presses_from_air(double factor) {
  std::vector<RecordingRow> rows;
  for (int i = 0; i < 20000; ++i) {
    const double position_m = -3.5e-3 - 6.5e-3 * std::cos(2e-3 * std::acos(-1.0) * i);
    const double depth_m = std::max(0.0, position_m);
    rows.push_back({0.0, position_m, factor * 8e5 * depth_m * depth_m + 4e-3 * std::sin(977.0 * i * 1e-3 * i)});
  }
  return rows;
}

// Most of both curves is air, where all forces are equal.
TEST(ForceCurve, AirDoesNotDecide) {
  const auto found = difference_of(presses_from_air(1.0), presses_from_air(3.0));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->median_N, 0.0, 0.01);
  EXPECT_GT(found->median_jnds, 2.0);
}

TEST(ForceCurve, AToolAtRestHasNoBins) {
  const std::vector<RecordingRow> rest(20, {1e-3, 0.5});
  EXPECT_EQ(common_bin_m(rest, rest), 0.0);
}

}  // namespace
}  // namespace palpate
