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

// Repeats every value of a channel for `rows` rows, as a sensor of 1 / rows of the rate.
void hold(Recording& recording, double RecordingRow::*column, double rows) {
  double next = 0.0;
  double value = 0.0;
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    if (static_cast<double>(i) >= next) {
      value = recording.rows[i].*column;
      next += rows;
    }
    recording.rows[i].*column = value;
  }
}

void quantise(Recording& recording, double step_N) {
  for (RecordingRow& row : recording.rows) row.force_N = step_N * std::round(row.force_N / step_N);
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

TEST(RecordingFaults, UsesTheUpdatesOfASlowChannel) {
  for (const auto column : {&RecordingRow::position_m, &RecordingRow::force_N}) {
    for (const double rows : {5.0, 12.5, 19.0, 44.0, 100.0}) {
      SCOPED_TRACE(rows);
      Recording recording = silicone();
      const double step_s = recording.rows[1].time_s - recording.rows[0].time_s;
      const auto recorded = static_cast<double>(recording.rows.size());
      hold(recording, column, rows);
      const RecordingFaults faults = remove_faults(recording);
      EXPECT_EQ(faults.held_force, column == &RecordingRow::force_N);
      EXPECT_NEAR(faults.update_step_s, rows * step_s, 0.02 * rows * step_s);
      EXPECT_NEAR(static_cast<double>(recording.rows.size()), recorded / rows, 0.02 * recorded / rows + 2.0);
    }
  }
}

// A load cell of 80 Hz with steps of 10 mN, and one whose intervals vary by a row.
TEST(RecordingFaults, AHeldForceMayBeQuantisedAndJitter) {
  for (const double step_N : {1e-3, 10e-3, 50e-3}) {
    Recording recording = silicone();
    quantise(recording, step_N);
    hold(recording, &RecordingRow::force_N, 12.5);
    EXPECT_TRUE(remove_faults(recording).held_force) << step_N;
  }
  Recording late = silicone();
  double value = 0.0;
  for (std::size_t i = 0, next = 0; i < late.rows.size(); ++i) {
    if (i == next) {
      value = late.rows[i].force_N;
      next += 11 + (i * 7 % 5) / 2;
    }
    late.rows[i].force_N = value;
  }
  EXPECT_TRUE(remove_faults(late).held_force);
}

// A tool that moves in steps and rests in between: the force follows in steps of its own resolution.
TEST(RecordingFaults, AForceThatRestsWithTheToolIsNoSlowChannel) {
  Recording steps;
  RandomStream random(5, 0);
  for (int i = 0; i < 3000; ++i) {
    const double depth_m = 0.3e-3 * std::abs(20 - i / 10 % 40);
    const double force_N = 0.1 * std::round(800.0 * depth_m / 0.1);
    steps.rows.push_back({0.1 * i, depth_m + 1e-6 * random.uniform(-1.0, 1.0), force_N, 0.0, 0.0});
  }
  EXPECT_FALSE(remove_faults(steps).any());
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
