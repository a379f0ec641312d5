// The simulated hand as a device: exploration, reaction to forces, repeatability.
#include "devices/virtual/simulated_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

constexpr double kTick_s = 1e-3;

// The positions of the hand on a spring in `ticks` ticks.
std::vector<double> explore(HandDevice& device, double stiffness_N_per_m, int ticks) {
  std::vector<double> positions_m;
  DeviceSample sample;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(device.read(kTick_s * i, sample));
    EXPECT_LT(std::abs(sample.tool.position_m), 0.1) << "finite and stable";
    positions_m.push_back(sample.tool.position_m);
    device.write(stiffness_N_per_m * std::max(0.0, sample.tool.position_m));
  }
  return positions_m;
}

TEST(HandDevice, PressesAndLeavesAgainAndAgain) {
  HandDevice device;
  const std::vector<double> positions_m = explore(device, 800.0, 30000);
  int presses = 0;
  for (std::size_t i = 1; i < positions_m.size(); ++i) presses += positions_m[i] > 0.0 && positions_m[i - 1] <= 0.0;
  EXPECT_GE(presses, 10) << "in half a minute";
  const double deepest_m = *std::max_element(positions_m.begin(), positions_m.end());
  EXPECT_GT(800.0 * deepest_m, 3.0) << "N: it presses in earnest";
  // It aims for at most 6 N, with an error of up to half in its estimate of the stiffness.
  EXPECT_LT(800.0 * deepest_m, 9.0);
}

// The same seed in air and on springs: a stiffer spring reduces the depth.
TEST(HandDevice, IsPushedBackByTheForce) {
  double before_m = 0.03;
  for (const double stiffness_N_per_m : {200.0, 800.0, 3000.0}) {
    HandDevice device;
    const std::vector<double> positions_m = explore(device, stiffness_N_per_m, 30000);
    const double deepest_m = *std::max_element(positions_m.begin(), positions_m.end());
    EXPECT_LT(deepest_m, before_m);
    EXPECT_GT(*std::min_element(positions_m.begin(), positions_m.end()), -0.03) << "stable";
    before_m = deepest_m;
  }
  HandDevice other(3);
  explore(other, 3000.0, 30000);
  HandDevice device;
  const std::vector<double> in_air_m = explore(device, 0.0, 30000);
  EXPECT_LT(*std::max_element(in_air_m.begin(), in_air_m.end()), 1.1 * HandSettings().deepest_m)
      << "where nothing pushes back, only its overshoot is deeper";
}

TEST(HandDevice, GivesOneSampleATimeAndSitsOutAStall) {
  HandDevice device;
  explore(device, 500.0, 2000);
  DeviceSample sample;
  EXPECT_FALSE(device.read(1.999, sample)) << "no time has passed";
  ASSERT_TRUE(device.read(2.0, sample));
  const double before_m = sample.tool.position_m;
  ASSERT_TRUE(device.read(60.0, sample));
  EXPECT_LT(std::abs(sample.tool.position_m - before_m), 0.02) << "20 ms at no more than 1 m/s";
}

}  // namespace
}  // namespace palpate
