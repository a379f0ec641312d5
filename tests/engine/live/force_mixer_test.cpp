// Switching models without a force step.
#include "engine/live/force_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

constexpr double kTick_s = 1e-3;
constexpr int kWindow = 10;  // ticks in 10 ms

// The largest change within any 10 ms, over the JND of the smaller force.
double worst_over_jnd(const std::vector<double>& forces_N) {
  const JndLine jnd;
  double worst = 0.0;
  for (std::size_t i = 0; i < forces_N.size(); ++i) {
    for (std::size_t j = i; j < std::min(forces_N.size(), i + kWindow + 1); ++j) {
      const double smaller_N = std::min(std::abs(forces_N[i]), std::abs(forces_N[j]));
      worst = std::max(worst, std::abs(forces_N[j] - forces_N[i]) / jnd.at(smaller_N));
    }
  }
  return worst;
}

TEST(ForceMixer, NeverStepsByMoreThanAJndInTenMilliseconds) {
  for (const double other_N : {0.0, 0.5, 3.1, 12.0, 40.0}) {
    ForceMixer mixer({});
    ForceMixer::Forces forces_N{};
    forces_N[0] = 3.0;
    forces_N[1] = other_N;
    std::vector<double> felt_N(20, mixer.mix(forces_N, 0, kTick_s));
    for (int i = 0; i < 3000; ++i) felt_N.push_back(mixer.mix(forces_N, 1, kTick_s));
    EXPECT_EQ(felt_N.back(), other_N) << "it arrives, exactly";
    EXPECT_TRUE(mixer.settled_on(1));
    EXPECT_LE(worst_over_jnd(felt_N), 1.0) << other_N;
  }
}

TEST(ForceMixer, SwitchingToAndFroInMidFadeIsNoKickEither) {
  ForceMixer mixer({});
  ForceMixer::Forces forces_N{};
  forces_N[0] = 1.0;
  forces_N[1] = 5.0;
  forces_N[2] = 0.2;
  std::vector<double> felt_N;
  for (std::size_t i = 0; i < 5000; ++i) felt_N.push_back(mixer.mix(forces_N, (i / 37) % 3, kTick_s));
  EXPECT_LE(worst_over_jnd(felt_N), 1.0);
}

TEST(ForceMixer, FollowsTheModelInTheHandUnhindered) {
  ForceMixer mixer({});
  for (const double force_N : {0.0, 5.0, 0.1, 30.0}) {
    ForceMixer::Forces forces_N{};
    forces_N[0] = force_N;
    EXPECT_EQ(mixer.mix(forces_N, 0, kTick_s), force_N);
  }
}

TEST(ForceMixer, SwitchesAtOnceInTheAirAndBelowWhatCanBeFelt) {
  ForceMixer mixer({});
  ForceMixer::Forces forces_N{};
  EXPECT_EQ(mixer.mix(forces_N, 3, kTick_s), 0.0);
  EXPECT_TRUE(mixer.settled_on(3));
  forces_N.fill(2.0);
  forces_N[4] = 2.01;  // a tenth of a JND is 0.019 N
  EXPECT_EQ(mixer.mix(forces_N, 4, kTick_s), 2.01);
}

TEST(ForceMixer, AStallIsNoLicenceAndNoTimeIsNoStep) {
  ForceMixer mixer({});
  ForceMixer::Forces forces_N{};
  forces_N[1] = 10.0;
  EXPECT_EQ(mixer.mix(forces_N, 1, 0.0), 0.0);
  EXPECT_EQ(mixer.mix(forces_N, 1, -1.0), 0.0);
  EXPECT_LE(mixer.mix(forces_N, 1, 5.0), 0.065);
}

}  // namespace
}  // namespace palpate
