#include "scenes/evaluation/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

TEST(NoiseFloor, IsThatOfANormalErrorAtOneForce) {
  // 65 mN of noise at 0 N mean force would be one JND there: erf(1 / sqrt 2) = 68.27 %,
  // and 99 % of the errors up to 2.576 JND.
  Recording recording;
  RandomStream random(1, 0);
  for (int i = 0; i < 20000; ++i) recording.rows.push_back({1e-3 * i, 1e-3, 0.065 * random.normal()});
  const NoiseFloor floor = noise_floor({&recording}, JndLine{0.065, 0.0});
  // The noise is identified from the quietest fifth of the recording, which takes it up
  // to a seventh low where there is nothing but noise.
  EXPECT_NEAR(floor.force_noise_N, 0.065, 0.010);
  const double noise_over_jnd = floor.force_noise_N / 0.065;
  EXPECT_NEAR(floor.within_jnd, std::erf(1.0 / (std::sqrt(2.0) * noise_over_jnd)), 0.01);
  EXPECT_NEAR(floor.p99_error_over_jnd, 2.576 * noise_over_jnd, 0.03);
}

TEST(NoiseFloor, OutOfContactCountsNothing) {
  Recording recording;
  for (int i = 0; i < 100; ++i) recording.rows.push_back({1e-3 * i, -1e-3, 0.0});
  EXPECT_EQ(noise_floor({&recording}, JndLine{}).within_jnd, 1.0);
}

}  // namespace
}  // namespace palpate
