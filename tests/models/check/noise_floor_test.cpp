#include "models/check/recording_measures.h"

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
  const PreparedRecordingPointer prepared = prepare_recording(recording);
  const NoiseFloor floor = noise_floor({prepared.get()}, JndLine{0.065, 0.0});
  EXPECT_NEAR(floor.force_noise_N, 0.065, 0.002);  // the standard error of the 0.2 quantile of 400 windows, twice
  const double noise_over_jnd = floor.force_noise_N / 0.065;
  EXPECT_NEAR(floor.within_jnd, std::erf(1.0 / (std::sqrt(2.0) * noise_over_jnd)), 0.01);
  EXPECT_NEAR(floor.p99_error_over_jnd, 2.576 * noise_over_jnd, 0.03);
}

}  // namespace
}  // namespace palpate
