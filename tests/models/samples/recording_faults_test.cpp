// Planted dropouts and repeated positions are found. Other recordings lose no row.
#include "models/samples/recording_faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"
#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

const Recording& silicone() {
  static const Recording made = *test::rig_recording(test::train_settings("silicone"));
  return made;
}

// Sets `share` of the rows to 0; returns how many.
std::size_t drop(Recording& recording, double RecordingRow::*column, double share) {
  RandomStream random(7, 0);
  std::size_t count = 0;
  for (RecordingRow& row : recording.rows) {
    if (random.uniform(0.0, 1.0) >= share) continue;
    row.*column = 0.0;
    ++count;
  }
  return count;
}

void repeat_positions(Recording& recording, std::size_t rows) {
  for (std::size_t i = 0; i < recording.rows.size(); ++i)
    recording.rows[i].position_m = recording.rows[i - i % rows].position_m;
}

TEST(RecordingFaults, LeavesEveryVirtualMaterialAsItIs) {
  for (const Material& material : materials()) {
    Recording recording = *test::rig_recording(test::train_settings(std::string(material.name)));
    const std::size_t rows = recording.rows.size();
    EXPECT_FALSE(remove_faults(recording).any()) << material.name;
    EXPECT_EQ(recording.rows.size(), rows) << material.name;
  }
}

TEST(RecordingFaults, FindsDropoutsOfThePosition) {
  for (const double share : {0.005, 0.01, 0.03}) {
    Recording recording = silicone();
    const std::size_t planted = drop(recording, &RecordingRow::position_m, share);
    const RecordingFaults faults = remove_faults(recording);
    // The others are not detectable: the position is near 0 anyway, or two dropouts are adjacent.
    EXPECT_GT(static_cast<double>(faults.position_dropouts), 0.8 * static_cast<double>(planted)) << share;
    EXPECT_LE(faults.position_dropouts, planted + planted / 20) << share;
    EXPECT_EQ(faults.force_dropouts, 0u) << share;
    EXPECT_EQ(recording.rows.size(), faults.rows - faults.position_dropouts) << share;
  }
}

TEST(RecordingFaults, FindsDropoutsOfTheForceWhereThereIsAForce) {
  for (const double share : {0.005, 0.01, 0.03, 0.05}) {
    Recording recording = silicone();
    drop(recording, &RecordingRow::force_N, share);
    std::size_t far = 0;
    for (std::size_t i = 0; i < recording.rows.size(); ++i)
      if (recording.rows[i].force_N == 0.0 && silicone().rows[i].force_N > 0.1) ++far;
    const RecordingFaults faults = remove_faults(recording);
    EXPECT_GT(static_cast<double>(faults.force_dropouts), 0.85 * static_cast<double>(far)) << share;
    EXPECT_EQ(faults.position_dropouts, 0u) << share;
  }
}

TEST(RecordingFaults, ATapIsNoDropout) {
  Recording taps;
  for (int i = 0; i < 2000; ++i) {
    const double depth_m = i % 20 == 10 ? 4e-3 : 0.0;  // 100 ms long, in one row of a slow recording
    taps.rows.push_back({0.1 * i, depth_m + 1e-6 * std::sin(3.0 * i), 500.0 * depth_m, 0.0, 0.0});
  }
  EXPECT_EQ(remove_faults(taps).position_dropouts, 0u);
}

TEST(RecordingFaults, UsesTheUpdatesOfASlowPositionChannel) {
  for (const std::size_t rows : {5u, 19u, 44u, 100u}) {
    Recording recording = silicone();
    const double step_s = recording.rows[1].time_s - recording.rows[0].time_s;
    const std::size_t recorded = recording.rows.size();
    repeat_positions(recording, rows);
    const RecordingFaults faults = remove_faults(recording);
    EXPECT_NEAR(faults.update_step_s, static_cast<double>(rows) * step_s, 0.02 * static_cast<double>(rows) * step_s);
    EXPECT_NEAR(static_cast<double>(recording.rows.size()), static_cast<double>(recorded / rows), 2.0);
  }
}

TEST(RecordingFaults, AnEncoderIsNoSlowChannel) {
  Recording ramp;  // of varying speed, in steps of 10 um
  for (int i = 0; i < 5000; ++i) {
    const double depth_m = 3e-3 * (1.0 - std::cos(2e-3 * i));
    ramp.rows.push_back({1e-3 * i, 10e-6 * std::floor(depth_m / 10e-6), 300.0 * depth_m, 0.0, 0.0});
  }
  EXPECT_FALSE(remove_faults(ramp).any());
}

TEST(RecordingFaults, BlamesNoRealRecording) {
  if (!std::filesystem::exists(test::real_data())) GTEST_SKIP() << "no real recordings here";
  for (const std::filesystem::path& folder : {test::real_data(), test::real_data() / "../labs"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".csv") continue;
      RecordingFaults faults;
      ASSERT_TRUE(read_usable_recording(entry.path().string(), kAllRows, &faults).ok()) << entry.path();
      EXPECT_FALSE(faults.any()) << entry.path();
    }
  }
}

}  // namespace
}  // namespace palpate
