#include "models/samples/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

RecordingOffset corrected_by(double offset_m, double force_zero_N) {
  RecordingOffset surface;
  surface.offset_m = offset_m;
  surface.force_zero_N = force_zero_N;
  return surface;
}

std::vector<MotionRow> rows_of(MotionSource& source) {
  std::vector<MotionRow> rows;
  const Status status = source.for_each([&](const MotionRow& row) { rows.push_back(row); });
  EXPECT_TRUE(status.ok());
  return rows;
}

std::vector<std::string> names_of(const MotionSource& source) {
  std::vector<std::string> names;
  for (const auto& recording : source.recordings()) names.push_back(recording.name);
  return names;
}

void expect_same(const std::vector<MotionRow>& a, const std::vector<MotionRow>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].sample.position_m, b[i].sample.position_m) << i;
    ASSERT_EQ(a[i].motion.position_m, b[i].motion.position_m) << i;
    ASSERT_EQ(a[i].motion.velocity_m_per_s, b[i].motion.velocity_m_per_s) << i;
    ASSERT_EQ(a[i].force_N, b[i].force_N) << i;
    ASSERT_EQ(a[i].stroke, b[i].stroke) << i;
    ASSERT_EQ(a[i].first, b[i].first) << i;
  }
}

// A long recording is thinned, with the motion that was estimated from all rows.
TEST(MotionSource, OfLongRecordingsKeepsEveryNthRow) {
  constexpr std::size_t kMost = 8000;
  const std::vector<PreparedRecordingPointer> inputs{prepare_recording(test::example_recording(60000, 1000.0, 30e-6)),
                                                     prepare_recording(test::example_recording(30000, 1000.0, 0.0))};
  MotionSource whole(inputs);
  MotionSource thinned(inputs, kMost);
  for (MotionSource* source : {&whole, &thinned}) source->correct({corrected_by(1e-3, 0.5), {}});
  const auto all = rows_of(whole);
  EXPECT_EQ(thinned.rows(), 0u);
  const auto rows = rows_of(thinned);
  EXPECT_EQ(names_of(thinned), names_of(whole));
  EXPECT_EQ(thinned.rows(), 90000u);
  EXPECT_EQ(thinned.force_noise_N(), whole.force_noise_N());
  ASSERT_EQ(rows.size(), 7500u);  // every 12th
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(all[12 * i].sample.position_m, rows[i].sample.position_m);
    EXPECT_EQ(all[12 * i].motion.velocity_m_per_s, rows[i].motion.velocity_m_per_s);
    EXPECT_EQ(all[12 * i].force_N, rows[i].force_N);
    EXPECT_EQ(all[12 * i].first, rows[i].first);
  }
}

TEST(MotionSource, CountsStrokesAndRecordings) {
  Recording recording;
  for (int i = 0; i < 40; ++i) {
    const bool pressed = i % 10 < 3 || i >= 38;  // five presses, the first from the beginning and the last to the end
    recording.rows.push_back({1e-3 * i, pressed ? 1e-3 : -1e-3, pressed ? 1.0 : 0.0, 0.0, 0.0});
  }
  MotionSource source({prepare_recording(recording), prepare_recording(recording)});
  const auto rows = rows_of(source);
  ASSERT_EQ(rows.size(), 80u);
  EXPECT_EQ(rows[0].stroke, 1);
  EXPECT_EQ(rows[39].stroke, 5);
  EXPECT_EQ(rows[40].stroke, 6) << "a stroke does not continue in the next recording";
  EXPECT_EQ(rows[79].stroke, 10);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].first, i % 40 == 0);
    EXPECT_EQ(rows[i].recording, i < 40 ? 0 : 1);
  }
}

// Contact and strokes are determined from the corrected position.
TEST(MotionSource, CorrectsPositionsAndForces) {
  Recording recording;
  for (int i = 0; i < 40; ++i) recording.rows.push_back({1e-3 * i, i % 10 >= 5 ? 1e-3 : -1e-3, 1.0, 0.0, 0.0});
  MotionSource source({prepare_recording(recording)});
  const auto before = rows_of(source);
  source.correct({corrected_by(0.5e-3, 0.25)}, 1.5e-3);
  const auto out = rows_of(source);
  EXPECT_EQ(out[5].sample.position_m, 1e-3 - 2e-3);
  EXPECT_EQ(out[5].motion.position_m, before[5].motion.position_m - 2e-3);
  EXPECT_EQ(out[5].motion.velocity_m_per_s, before[5].motion.velocity_m_per_s);
  EXPECT_EQ(out[5].force_N, 0.75);
  EXPECT_EQ(out.back().stroke, 0);
  source.correct({corrected_by(-2e-3, 0.0)});
  EXPECT_EQ(rows_of(source).back().stroke, 1);
  source.correct({});
  expect_same(rows_of(source), before);
}

TEST(MotionSource, TheOrderOfInputsChangesNothing) {
  const Recording first = test::example_recording(2000, 1000.0, 30e-6);
  Recording second = first;
  for (RecordingRow& row : second.rows) row.force_N *= 2.0;
  const auto a = prepare_recording(first);
  const auto b = prepare_recording(second);
  const auto c = prepare_recording(test::example_recording(3000, 1000.0));
  MotionSource one({a, b, c});
  MotionSource other({c, a, b});
  expect_same(rows_of(other), rows_of(one));
  EXPECT_EQ(names_of(other), names_of(one));
}

TEST(MotionSource, AsksNowAndThenWhetherToGoOn) {
  MotionSource source({prepare_recording(test::example_recording(200000, 1000.0))});
  const FitControl stop{[](double) { return false; }};
  std::size_t seen = 0;
  const auto count = [&](const MotionRow&) { ++seen; };
  EXPECT_FALSE(source.for_each(count, stop).ok());  // during the first pass
  EXPECT_EQ(seen, 0u);
  int questions = 0;
  const FitControl on{[&](double fraction) { return ++questions > 0 && fraction == 0.5; }};
  ASSERT_TRUE(source.for_each(count, on.at(0.5)).ok());
  EXPECT_EQ(seen, 200000u);
  EXPECT_GE(questions, 6);
  seen = 0;
  EXPECT_FALSE(source.for_each(count, stop).ok());  // from the stored rows
  EXPECT_EQ(seen, kRowsPerQuestion);
}

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
  const auto extent = measure_extent(source, {}, {});
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
  const auto extent = measure_extent(source, {}, {});
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
