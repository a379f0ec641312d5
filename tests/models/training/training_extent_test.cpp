#include "models/training/training_extent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fitting.h"

namespace palpate {
namespace {

// Presses of 2 mm, a second each, by a spring of 500 N/m.
Recording presses(int rows) {
  Recording recording;
  recording.name = "presses";
  for (int i = 0; i < rows; ++i) {
    const double position_m = 2e-3 * std::sin(2.0 * M_PI * 1e-3 * i);
    recording.rows.push_back({1e-3 * i, position_m, 500.0 * std::max(0.0, position_m), 0.0, 0.0});
  }
  return recording;
}

TEST(TrainingExtent, MeasuresDepthStrokesAndWays) {
  MotionSource source({prepare_recording(presses(10000))});
  const auto extent = measure_extent(source, {});
  ASSERT_TRUE(extent.ok());
  EXPECT_NEAR(extent->depth_m, 2e-3, 1e-4);  // the error of the motion estimate at a turn
  EXPECT_NEAR(extent->force_N, 1.0, 1e-3);
  EXPECT_EQ(extent->strokes, 10u);
  EXPECT_NEAR(static_cast<double>(extent->contact_samples), 5000.0, 20.0);
  EXPECT_GT(extent->unloading_path_m, 0.9 * extent->loading_path_m);
  EXPECT_NEAR(extent->sample_s, 1e-3, 1e-9);
  EXPECT_NEAR(extent->longest_recording_s, 9.999, 1e-9);
}

// The surface position found for a spring with a preload, with alternating noise of +-`noise_N`.
double beginning_of(double preload_N, double noise_N, double stiffness_N_per_m) {
  Recording recording = presses(10000);
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    RecordingRow& row = recording.rows[i];
    row.force_N = preload_N + (i % 2 == 0 ? noise_N : -noise_N) + stiffness_N_per_m * row.position_m;
  }
  MotionSource source({prepare_recording(recording)});
  const auto extent = measure_extent(source, {});
  const auto beginning_m = find_preload_surface(source, *extent, {}, {});
  return beginning_m.ok() ? *beginning_m : 1.0;
}

TEST(FindBeginning, IsWhereAForceThatIsFeltBeginsAndElseTheZeroOfPositions) {
  EXPECT_NEAR(beginning_of(0.3, 0.0, 500.0), -0.6e-3, 0.03e-3);
  EXPECT_EQ(beginning_of(0.0, 0.0, 500.0), 0.0);
  EXPECT_EQ(beginning_of(0.05, 0.0, 500.0), 0.0);  // the preload is below the JND
  EXPECT_EQ(beginning_of(0.3, 3.0, 500.0), 0.0);   // the preload is within two standard errors of 0
  EXPECT_EQ(beginning_of(3.0, 0.0, 500.0), 0.0);   // 6 mm outside, farther than the recording's depth
  EXPECT_EQ(beginning_of(-8.0, 0.0, 500.0), 0.0);  // a negative offset is not a preload
}

}  // namespace
}  // namespace palpate
