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

TEST(NoiseFloor, ContactCountsFromTheSurface) {
  // A spring with noise whose surface is at 1 mm; the force of the air is 0.2 N.
  Recording recording;
  RandomStream random(1, 0);
  for (int i = 0; i < 20000; ++i) {
    const double position_m = 2e-3 * (1.0 - std::cos(1e-3 * i)) - 0.5e-3;
    recording.rows.push_back(
        {1e-3 * i, position_m, 0.2 + 2000.0 * std::max(0.0, position_m - 1e-3) + 0.05 * random.normal()});
  }
  const PreparedRecordingPointer prepared = prepare_recording(recording);
  ASSERT_NEAR(prepared->surface.offset_m, 1e-3, 0.1e-3);
  const JndLine jnd;
  double sum = 0.0;
  int count = 0;
  for (const RecordingRow& row : prepared->recording.rows) {
    if (!(row.position_m > 1e-3)) continue;
    sum += std::erf(jnd.at(2000.0 * (row.position_m - 1e-3)) / (std::sqrt(2.0) * white_force_noise_N(*prepared)));
    ++count;
  }
  EXPECT_NEAR(noise_floor({prepared.get()}, jnd).within_jnd, sum / count, 0.005);
}

}  // namespace
}  // namespace palpate
