#include "models/samples/samples.h"

#include <gtest/gtest.h>

#include "engine/base/random_stream.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

// Presses of a spring of 500 N/m from 3 mm outside to 5 mm inside and back, at 20 mm/s
// and 1 kHz. There are `presses` of them, `rest_s` apart in air. The surface moves by
// `creep_m` from press to press.
Recording spring_presses(int presses, double rest_s, double creep_m = 0.0) {
  Recording recording;
  recording.name = "spring";
  double time_s = 0.0;
  for (int press = 0; press < presses; ++press) {
    const auto rows = static_cast<int>((0.8 + rest_s) * 1000.0);
    for (int i = 0; i < rows; ++i) {
      time_s += 1e-3;
      const double into_m = 5e-3 - 20.0 * std::abs(1e-3 * i - 0.4) * 1e-3;
      const double position_m = std::max(-3e-3, into_m);
      const double force_N = 500.0 * std::max(0.0, position_m - press * creep_m);
      recording.rows.push_back({time_s, position_m, force_N, 0.0, 0.0});
    }
  }
  return recording;
}

Recording moved(Recording recording, double offset_m, double zero_N = 0.0) {
  for (RecordingRow& row : recording.rows) {
    row.position_m += offset_m;
    row.force_N += zero_N;
  }
  return recording;
}

SurfaceEstimate estimate_surface(const Recording& recording) { return prepare_recording(recording)->surface; }

Recording rig(const std::string& material, std::uint64_t seed) {
  RigSettings settings = test::train_settings(material);
  settings.seed = seed;
  settings.seconds = 10.0;
  return *test::rig_recording(settings);
}

// The required accuracy is 0.02 mm with an encoder of 0.03 mm and force noise of 5 mN. An
// offset that is not significantly different from 0 is set to 0.
TEST(SurfaceEstimate, FindsTheShiftAndTheForceZeroOfVirtualRecordings) {
  for (const char* material : {"maxwell", "foam", "elastic"}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const Recording recording = rig(material, seed);
      for (const double shift_m : {-1.2e-3, -0.5e-3, -0.05e-3, 0.05e-3, 0.3e-3}) {
        const SurfaceEstimate estimate = estimate_surface(moved(recording, shift_m, 0.1));
        EXPECT_NEAR(estimate.raw_offset_m, shift_m, 0.02e-3) << material << ", seed " << seed;
        const bool identified = std::abs(estimate.raw_offset_m) > 2.0 * estimate.standard_error_m;
        EXPECT_EQ(estimate.offset_m, identified ? estimate.raw_offset_m : 0.0) << material << ", seed " << seed;
        EXPECT_NEAR(estimate.force_zero_N, 0.1, 1e-3) << material << ", seed " << seed;
      }
    }
  }
}

TEST(SurfaceEstimate, InventsNothing) {
  for (const Material& material : materials()) {
    const SurfaceEstimate estimate = estimate_surface(rig(std::string(material.name), 3));
    EXPECT_EQ(estimate.offset_m, 0.0) << material.name;
    EXPECT_EQ(estimate.force_zero_N, 0.0) << material.name;
  }
}

// A press after 22 s. At 20 kHz the first kOnsetRows rows are 20 s of air; at 1 kHz there are too many rows to keep,
// but none may be left out.
TEST(SurfaceEstimate, IsFoundLateInALongRecordingOfManyRows) {
  for (const double rate_Hz : {20000.0, 1000.0}) {
    Recording recording;
    for (int i = 0; i < 500000; ++i) {
      const double time_s = i / rate_Hz;
      const double position_m = std::max(-3e-3, 5e-3 - 20e-3 * std::abs(time_s - 22.4));
      recording.rows.push_back({time_s, position_m, 500.0 * std::max(0.0, position_m - 0.3e-3), 0.0, 0.0});
    }
    const auto prepared = prepare_recording(std::move(recording));
    EXPECT_LE(prepared->rows.size(), kOnsetRows);
    EXPECT_LE(prepared->rows[1].tool.time_s, kCoarsestOnset_s);
    EXPECT_TRUE(prepared->surface.identified()) << rate_Hz;
    EXPECT_NEAR(prepared->surface.raw_offset_m, 0.3e-3, kLeastOffset_m) << rate_Hz;
  }
}

TEST(PreparedRecording, OfTooManyRowsHasEverySecondWithTheMotionFromAll) {
  Recording recording;
  for (std::size_t i = 0; i <= kMostKeptRows; ++i)
    recording.rows.push_back({1e-3 * static_cast<double>(i), 1e-3 * std::sin(1e-3 * static_cast<double>(i)), 0.0});
  const std::vector<Sample> rows = thinned_rows(recording, kMostKeptRows);
  const auto prepared = prepare_recording(std::move(recording));
  EXPECT_EQ(prepared->recorded_rows, kMostKeptRows + 1);
  ASSERT_EQ(prepared->recording.rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(prepared->recording.rows[i].time_s, rows[i].tool.time_s);
    ASSERT_EQ(prepared->motion[i].velocity_m_per_s, rows[i].motion.velocity_m_per_s);
  }
}

// The inertial force of the tool must not be taken for contact.
TEST(SurfaceEstimate, TellsInertiaFromContact) {
  Recording recording = rig("silicone", 2);
  for (RecordingRow& row : recording.rows) row.force_N += 0.06 * row.acceleration_m_per_s2;
  const SurfaceEstimate estimate = estimate_surface(recording);
  EXPECT_NEAR(estimate.air.tool_mass_kg, 0.06, 0.01);
  EXPECT_NEAR(estimate.raw_offset_m, 0.0, 0.1e-3);
  EXPECT_EQ(estimate.offset_m, 0.0);
  EXPECT_EQ(estimate.force_zero_N, 0.0);
}

TEST(SurfaceEstimate, SaysSoWhereThereIsNoAirAndNoForce) {
  Recording no_force = spring_presses(1, 0.5);
  for (RecordingRow& row : no_force.rows) row.force_N = 0.0;
  const SurfaceEstimate nothing = estimate_surface(no_force);
  EXPECT_EQ(nothing.offset_m, 0.0);
  EXPECT_TRUE(std::isinf(nothing.standard_error_m));

  Recording no_air = spring_presses(1, 0.5);
  std::erase_if(no_air.rows, [](const RecordingRow& row) { return row.position_m < 0.5e-3; });
  const SurfaceEstimate held = estimate_surface(no_air);
  EXPECT_EQ(held.force_zero_N, 0.0);
  EXPECT_TRUE(std::isinf(held.air.zero_error_N));
  EXPECT_FALSE(held.air.found);
  EXPECT_FALSE(held.identified());
}

// Planted dropouts and repeated positions are found. Other recordings lose no row.

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

}  // namespace
}  // namespace palpate
