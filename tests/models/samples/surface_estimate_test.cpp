#include "models/samples/samples.h"

#include <gtest/gtest.h>

#include <cmath>

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

// With a sphere on a soft solid the force starts so softly that the accuracy is only about 0.05 mm.
TEST(SurfaceEstimate, FindsLargerShiftsWhereForceBeginsSoftly) {
  for (const char* material : {"silicone", "layered"}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const SurfaceEstimate estimate = estimate_surface(moved(rig(material, seed), -0.3e-3));
      EXPECT_NEAR(estimate.offset_m, -0.3e-3, 0.05e-3) << material << ", seed " << seed;
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

TEST(SurfaceEstimate, MeasuresASurfaceThatMoves) {
  const SurfaceEstimate still = estimate_surface(spring_presses(3, 6.0));
  EXPECT_EQ(still.offset_drift_m, 0.0);
  const SurfaceEstimate creeping = estimate_surface(spring_presses(3, 6.0, 0.1e-3));
  EXPECT_NEAR(creeping.offset_drift_m, 0.2e-3, 0.02e-3);
}

TEST(SurfaceEstimate, MeasuresADriftingForceZero) {
  Recording recording = spring_presses(3, 6.0);
  const double end_s = recording.rows.back().time_s;
  for (RecordingRow& row : recording.rows) row.force_N += 0.03 * row.time_s / end_s;
  // The drift is measured between the middles of the first and the last third.
  EXPECT_NEAR(estimate_surface(recording).air.drift_N, 0.02, 0.005);
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

}  // namespace
}  // namespace palpate
