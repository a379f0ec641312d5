// Compares parts computed four at a time with the equations of features.h.
#include "engine/tick/feature_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace palpate {
namespace {

double by_lane(double x, std::size_t lane) {
  V4 lanes{-1.0, -2.0, 3.0, 0.5};
  lanes[lane] = x;
  to_exponential(lanes);
  return lanes[lane];
}

// The reference, std::exp, is itself accurate to 1 ulp.
TEST(Exponential, IsGoodToAnUlp) {
  const double ulp = std::numeric_limits<double>::epsilon();
  for (double x = -690.0; x < 690.0; x += 0.0371) ASSERT_NEAR(by_lane(x, 1) / std::exp(x), 1.0, 2 * ulp) << x;
  for (double x = 1e-9; x < 1.0; x *= 1.01) ASSERT_NEAR(by_lane(-x, 2) / std::exp(-x), 1.0, 2 * ulp) << x;
}

DriveCurve drive_of(std::size_t i) {
  const double size = static_cast<double>(i + 1);
  return {4e-3 + 5e-4 * size, {0.3 * size, 0.1, 0.02 * size, 0.05}};
}
double time_of(std::size_t i) { return 1e-3 * std::pow(2.5, static_cast<double>(i)); }

// A motion in and out, beyond the reference depth of some drives.
double depth_at(int i) { return std::max(0.0, 9e-3 * std::sin(0.01 * i)); }

class FeatureLanes : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Parts, FeatureLanes, testing::Values(1, 2, 3, 4, 5, 13, 64),
                         [](const auto& instance) { return std::to_string(instance.param); });

TEST_P(FeatureLanes, BranchesFollowTheirEquation) {
  BranchLanes lanes;
  std::vector<double> z(GetParam(), 0.0);
  for (std::size_t i = 0; i < z.size(); ++i) lanes.add(drive_of(i), time_of(i % 13));
  PartMemory memory{};
  lanes.advance(0.0, depth_at(0), 0.0, memory);
  for (int t = 1; t < 1000; ++t) {
    const double step_s = 1e-3 * (1.0 + 0.5 * std::sin(1.0 * t));
    lanes.advance(depth_at(t - 1), depth_at(t), step_s, memory);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double keep = by_lane(-step_s / time_of(i % 13), 0);
      const double gain = time_of(i % 13) * (1.0 - keep) / step_s;
      z[i] = keep * z[i] + gain * (drive_of(i).at(depth_at(t)) - drive_of(i).at(depth_at(t - 1)));
      // A thousand steps of two exponentials, each accurate to an ulp.
      ASSERT_NEAR(sum_of_lanes(memory.value, i, 1), z[i], 1e-12) << i << " at " << t;
    }
  }
}

// Stops in the even lanes, creeping bristles in the odd ones.
TEST_P(FeatureLanes, BristlesFollowTheirEquations) {
  constexpr double kStep_s = 1e-3;
  BristleLanes lanes;
  PartMemory memory{};
  V4 force_N[kMaxLaneGroups];
  std::vector<double> bend(GetParam(), 0.0);
  const auto creeps = [](std::size_t i) { return i % 2 == 1; };
  const auto threshold = [&](std::size_t i) { return creeps(i) ? 5e-3 : 1e-4 * static_cast<double>(i + 1); };
  const auto time = [](std::size_t i) { return 1e-3 * std::pow(10.0, static_cast<double>(i % 5)); };
  for (std::size_t i = 0; i < bend.size(); ++i) lanes.add(drive_of(i), threshold(i), creeps(i) ? time(i) : 0.0);
  for (int t = 1; t < 1000; ++t) {
    lanes.advance(depth_at(t - 1), depth_at(t), kStep_s, memory.value, force_N);
    for (std::size_t i = 0; i < bend.size(); ++i) {
      if (creeps(i)) {
        const auto half = [&](double q) { return q / std::sqrt(1.0 + kStep_s / time(i) * (q / 5e-3) * (q / 5e-3)); };
        bend[i] = half(half(bend[i]) + depth_at(t) - depth_at(t - 1));
      } else {
        // Out of contact a stop relaxes to zero.
        const double limit_m = depth_at(t) > 0.0 ? threshold(i) : 0.0;
        bend[i] = std::clamp(bend[i] + depth_at(t) - depth_at(t - 1), -limit_m, limit_m);
      }
      // Products of creep are in another order: a difference of some ulps a step, which creep forgets.
      ASSERT_NEAR(sum_of_lanes(force_N, i, 1), drive_of(i).at(depth_at(t)) * bend[i] / threshold(i),
                  creeps(i) ? 1e-12 : 1e-15)
          << i << " at " << t;
    }
  }
}

}  // namespace
}  // namespace palpate
