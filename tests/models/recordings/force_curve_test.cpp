// Shifts between the force curves of two recordings, with shapes whose shift is known.
#include "models/check/force_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Ten strokes from 1 to 3 mm. The force is larger during loading by `friction_N` on either side of its mean.
std::vector<ForceAtPosition> strokes(double shift_m, double friction_N = 0.0, double factor = 1.0) {
  std::vector<ForceAtPosition> rows;
  for (int i = 0; i < 20000; ++i) {
    const double depth_m = 2e-3 - 1e-3 * std::cos(2e-3 * std::acos(-1.0) * i);
    const double friction = std::sin(2e-3 * std::acos(-1.0) * i) > 0.0 ? friction_N : -friction_N;
    rows.push_back({depth_m + shift_m, factor * 8e5 * depth_m * depth_m + friction});
  }
  return rows;
}

std::optional<double> shift_of(const std::vector<ForceAtPosition>& first, const std::vector<ForceAtPosition>& second) {
  const double bin_m = common_bin_m(first, second);
  return find_shift_m(ForceCurve(first, bin_m), ForceCurve(second, bin_m), JndLine{});
}

// A quarter of a bin of 2 mm / 60 is 8 um.
TEST(ForceCurve, FindsAShift) {
  for (const double shift_m : {-1e-3, 0.3e-3, 5e-3}) {
    const auto found = shift_of(strokes(0.0), strokes(shift_m));
    ASSERT_TRUE(found) << shift_m;
    EXPECT_NEAR(*found, shift_m, 17e-6) << shift_m;
  }
}

TEST(ForceCurve, ADifferenceBelowTheJndIsNoShift) {
  EXPECT_EQ(shift_of(strokes(0.0), strokes(0.0)), 0.0);
  EXPECT_EQ(shift_of(strokes(0.0), strokes(0.02e-3)), 0.0);
}

TEST(ForceCurve, AnotherStiffnessOrFrictionIsNoShift) {
  EXPECT_FALSE(shift_of(strokes(0.0), strokes(0.0, 0.0, 3.0)));
  EXPECT_FALSE(shift_of(strokes(0.0), strokes(0.0, 2.0)));
}

TEST(ForceCurve, ComparesOnlyCurvesThatOverlap) {
  const auto first = strokes(0.0);
  const auto second = strokes(1.9e-3);
  const double bin_m = common_bin_m(first, second);
  EXPECT_FALSE(difference(ForceCurve(first, bin_m), ForceCurve(second, bin_m), 0.0, JndLine{}));
  EXPECT_TRUE(difference(ForceCurve(first, bin_m), ForceCurve(second, bin_m), 1.9e-3, JndLine{}));
}

// Presses from 10 mm outside of the material to 3 mm inside, with pseudo-noise of 3 mN.
std::vector<ForceAtPosition> presses_from_air(double shift_m) {
  std::vector<ForceAtPosition> rows;
  for (int i = 0; i < 20000; ++i) {
    const double position_m = -3.5e-3 - 6.5e-3 * std::cos(2e-3 * std::acos(-1.0) * i);
    const double depth_m = std::max(0.0, position_m);
    rows.push_back({position_m + shift_m, 8e5 * depth_m * depth_m + 4e-3 * std::sin(977.0 * i * 1e-3 * i)});
  }
  return rows;
}

// Most of both curves is air, where any shift fits.
TEST(ForceCurve, AirDoesNotDecide) {
  const auto found = shift_of(presses_from_air(0.0), presses_from_air(2e-3));
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 2e-3, 0.11e-3);  // half a bin
}

TEST(ForceCurve, AToolAtRestHasNoBins) {
  const std::vector<ForceAtPosition> rest(20, {1e-3, 0.5});
  EXPECT_EQ(common_bin_m(rest, rest), 0.0);
}

}  // namespace
}  // namespace palpate
