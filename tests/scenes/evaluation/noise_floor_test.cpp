#include "scenes/evaluation/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

TEST(NoiseFloor, IsThatOfANormalErrorAtOneForce) {
  // Noise of 65 mN at a mean force of 0 N is one JND: erf(1 / sqrt 2) = 68.27 % are within the
  // JND, and the 99 % quantile is 2.576 JND.
  Recording recording;
  RandomStream random(1, 0);
  for (int i = 0; i < 20000; ++i) recording.rows.push_back({1e-3 * i, 1e-3, 0.065 * random.normal()});
  const NoiseFloor floor = noise_floor({prepare_recording(recording)}, JndLine{0.065, 0.0});
  // The noise is identified from the quietest fifth of the recording. In pure noise this
  // underestimates it by up to a seventh.
  EXPECT_NEAR(floor.force_noise_N, 0.065, 0.010);
  const double noise_over_jnd = floor.force_noise_N / 0.065;
  EXPECT_NEAR(floor.within_jnd, std::erf(1.0 / (std::sqrt(2.0) * noise_over_jnd)), 0.01);
  EXPECT_NEAR(floor.p99_error_over_jnd, 2.576 * noise_over_jnd, 0.03);
}

TEST(NoiseFloor, OutOfContactCountsNothing) {
  Recording recording;
  for (int i = 0; i < 100; ++i) recording.rows.push_back({1e-3 * i, -1e-3, 0.0});
  EXPECT_EQ(noise_floor({prepare_recording(recording)}, JndLine{}).within_jnd, 1.0);
}

}  // namespace
}  // namespace palpate
