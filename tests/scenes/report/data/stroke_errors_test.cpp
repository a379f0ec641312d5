#include "scenes/report/data/stroke_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

TEST(StrokeCounter, AStrokeGoesFromTouchToReleaseAndLongOnesAreCut) {
  StrokeCounter counter(100.0);
  int strokes = 0;
  int blocks = 0;
  for (int i = 0; i < 1000; ++i) {  // 10 Hz: the step is longer than the pause that noise may make
    const double time_s = 0.1 * i;
    const bool in_contact = i % 100 >= 10;  // 9 s at a time
    blocks += counter.begins_block(time_s, in_contact) ? 1 : 0;
    strokes += in_contact && counter.begins_stroke() ? 1 : 0;
  }
  EXPECT_EQ(strokes, 10);
  EXPECT_EQ(blocks, 50) << "9 s are five pieces of at most 2 s";
}

TEST(StrokeCounter, AShortRecordingHasTenBlocksAtLeast) {
  StrokeCounter counter(5.0);
  int blocks = 0;
  for (int i = 0; i < 5000; ++i) blocks += counter.begins_block(1e-3 * i, true) ? 1 : 0;
  EXPECT_EQ(blocks, 10) << "half a second each";
}

TEST(StrokeErrors, NeighbouringSamplesThatAreAlikeTellLess) {
  // Twenty strokes of 500 samples, all of a stroke with the same error: as if twenty samples.
  const JndLine jnd;
  StrokeErrors errors(jnd);
  RandomStream random(1, 0);
  double squares = 0.0;
  for (int stroke = 0; stroke < 20; ++stroke) {
    const double error_N = 0.02 * random.normal();
    squares += error_N * error_N;
    errors.begin_block(true);
    for (int i = 0; i < 500; ++i) errors.add(1.0 + error_N, 1.0, false);
  }
  const Evidence evidence = errors.evidence();
  const double rms_N = std::sqrt(squares / 20.0);
  EXPECT_NEAR(evidence.rms_error_N, rms_N, 1e-12);
  EXPECT_EQ(evidence.strokes, 20u);
  // The standard error of an RMS of 20 normal values is rms / sqrt(40); 95 % are 1.96
  // times that to either side. A factor of 1.6 either way allows for the one draw here.
  const double width_N = evidence.rms_interval_N.high - evidence.rms_interval_N.low;
  const double expected_N = 2.0 * 1.96 * rms_N / std::sqrt(40.0);
  EXPECT_GT(width_N, expected_N / 1.6);
  EXPECT_LT(width_N, expected_N * 1.6);
  EXPECT_LE(evidence.rms_interval_N.low, rms_N);
  EXPECT_GE(evidence.rms_interval_N.high, rms_N);
}

TEST(StrokeErrors, CountsWhatDecides) {
  StrokeErrors errors(JndLine{});
  for (int stroke = 0; stroke < 10; ++stroke) {
    errors.begin_block(true);
    for (int i = 0; i < 100; ++i) errors.add(stroke == 3 && i < 7 ? 1.5 : 1.0, 1.0, false);
  }
  const Evidence evidence = errors.evidence();
  EXPECT_EQ(evidence.beyond_samples, 7u);
  EXPECT_EQ(evidence.beyond_strokes, 1u);
  EXPECT_EQ(evidence.within_interval.high, 1.0) << "a resampling without that stroke is likely";
  EXPECT_LT(evidence.within_interval.low, 0.993);
  EXPECT_EQ(evidence.p99_interval.low, 0.0);
}

TEST(StrokeErrors, TheSameSamplesGiveTheSameIntervals) {
  const auto run = [] {
    StrokeErrors errors(JndLine{});
    RandomStream random(2, 0);
    for (int stroke = 0; stroke < 12; ++stroke) {
      errors.begin_block(true);
      for (int i = 0; i < 50; ++i) errors.add(1.0 + 0.1 * random.normal(), 1.0, false);
    }
    return errors.evidence();
  };
  EXPECT_EQ(run().p99_interval.low, run().p99_interval.low);
  EXPECT_EQ(run().p99_interval.high, run().p99_interval.high);
}

TEST(StrokeErrors, WithoutSamplesThereIsNothing) {
  const Evidence evidence = StrokeErrors(JndLine{}).evidence();
  EXPECT_EQ(evidence.samples, 0u);
  EXPECT_EQ(evidence.blocks, 0u);
}

}  // namespace
}  // namespace palpate
