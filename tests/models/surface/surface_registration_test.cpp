#include "models/surface/surface_registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/tick/evaluation.h"
#include "engine/tick/replay.h"
#include "models/model/file/model_io.h"
#include "models/model/file/model_json.h"
#include "models/surface/surface_estimate.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

using test::RecordingPtr;

RecordingPtr rig(const std::string& material, std::uint64_t seed, double offset_m = 0.0, double zero_N = 0.0) {
  RigSettings settings = test::train_settings(material);
  settings.seed = seed;
  settings.seconds = 12.0 + static_cast<double>(seed);
  auto copy = std::make_shared<Recording>(*test::rig_recording(settings));
  for (RecordingRow& row : copy->rows) {
    row.position_m += offset_m;
    row.force_N += zero_N;
  }
  return copy;
}

std::vector<RegisteredSurface> registered(const std::vector<RecordingPtr>& recordings) {
  std::vector<MotionSource::Input> inputs;
  for (const RecordingPtr& recording : recordings) inputs.push_back({"", recording});
  MotionSource source(std::move(inputs));
  return test::must(register_surfaces(source, test::scene_request("silicone_block").features));
}

// Longer recordings come first in a MotionSource: seed 3, 2, 1.
TEST(SurfaceRegistration, FindsEveryShiftAndZeroOfASet) {
  // On recordings this short 0.05 mm are not told from what the trend cannot follow.
  for (const double shift_m : {-0.5e-3, -0.2e-3, 0.2e-3, 0.5e-3}) {
    const auto surfaces = registered({rig("maxwell", 1), rig("maxwell", 2, shift_m, -0.05), rig("maxwell", 3)});
    ASSERT_EQ(surfaces.size(), 3u);
    EXPECT_NEAR(surfaces[0].offset_m, 0.0, 0.02e-3) << shift_m;
    EXPECT_NEAR(surfaces[1].offset_m, shift_m, 0.02e-3) << shift_m;
    EXPECT_NEAR(surfaces[2].offset_m, 0.0, 0.02e-3) << shift_m;
    EXPECT_NEAR(surfaces[1].force_zero_N, -0.05, 1e-3) << shift_m;
    EXPECT_EQ(surfaces[0].force_zero_N, 0.0) << shift_m;
  }
}

// An approach needs its rows: of a long recording those of the beginning, not one in eight.
TEST(SurfaceRegistration, FindsTheShiftOfALongRecording) {
  const RecordingPtr once = rig("maxwell", 1, 1e-3);
  auto longer = std::make_shared<Recording>(*once);
  const double length_s = once->rows.back().time_s - once->rows.front().time_s + 1e-3;
  for (int i = 1; longer->rows.size() < 1'700'000; ++i) {
    for (RecordingRow row : once->rows) {
      row.time_s += i * length_s;
      longer->rows.push_back(row);
    }
  }
  const auto surfaces = registered({longer});
  ASSERT_EQ(surfaces.size(), 1u);
  // As precisely as of the recording itself.
  EXPECT_NEAR(surfaces[0].offset_m, registered({once})[0].offset_m, 0.02e-3);
  EXPECT_NEAR(surfaces[0].offset_m, 1e-3, 0.1e-3);
}

// What the trend cannot follow of these materials looks like a shift of up to 0.07 mm.
TEST(SurfaceRegistration, FindsLargerShiftsOfMaterialsThatTheTrendDoesNotFollow) {
  for (const char* material : {"silicone", "gel", "tissue"}) {
    const auto surfaces = registered({rig(material, 1), rig(material, 2, 0.3e-3), rig(material, 3)});
    EXPECT_NEAR(surfaces[1].offset_m - surfaces[0].offset_m, 0.3e-3, 0.07e-3) << material;
  }
}

TEST(SurfaceRegistration, InventsNothing) {
  for (const Material& material : materials()) {
    const std::string name(material.name);
    for (const RegisteredSurface& surface : registered({rig(name, 4), rig(name, 5)})) {
      EXPECT_EQ(surface.offset_m, 0.0) << name;
      EXPECT_EQ(surface.force_zero_N, 0.0) << name;
    }
  }
}

// Of a recording alone, and of what all have in common, only where the model's zero
// lies depends on it: below a quarter of a millimetre it stays where it was recorded.
TEST(SurfaceRegistration, SmallShiftsOfAllStayAsRecorded) {
  EXPECT_EQ(registered({rig("maxwell", 1, 0.2e-3)})[0].offset_m, 0.0);
  for (const RegisteredSurface& surface : registered({rig("maxwell", 1, 0.2e-3), rig("maxwell", 2, 0.2e-3)})) {
    EXPECT_EQ(surface.offset_m, 0.0);
  }
  for (const RegisteredSurface& surface : registered({rig("maxwell", 1, 0.5e-3), rig("maxwell", 2, 0.5e-3)})) {
    EXPECT_NEAR(surface.offset_m, 0.5e-3, 0.02e-3);
  }
}

std::string model_of(const std::vector<RecordingPtr>& recordings, Surface surface = Surface::automatic) {
  TrainingRequest request = test::scene_request("silicone_block");
  request.surface = surface;
  const auto model = test::fit(test::prepare(recordings, request), &kKdTreeMethod);
  return test::must(write_model_text(model->data()));
}

TEST(SurfaceRegistration, TheOrderOfRecordingsChangesNoByteOfTheModel) {
  const RecordingPtr a = rig("silicone", 1);
  const RecordingPtr b = rig("silicone", 2, 0.2e-3);
  const RecordingPtr c = rig("foam", 2, -0.1e-3);
  const std::string model = model_of({a, b, c});
  EXPECT_EQ(model_of({c, a, b}), model);
  EXPECT_EQ(model_of({b, c, a}), model);
  EXPECT_EQ(model_of({c, b, a}, Surface::recorded), model_of({a, b, c}, Surface::recorded));
}

TEST(SurfaceRegistration, AModelSaysWhereTheSurfacesWere) {
  const auto prepared = test::prepare({rig("maxwell", 2, 0.5e-3)}, test::scene_request("silicone_block"));
  const auto& surfaces = prepared.common.provenance.surfaces;
  ASSERT_EQ(surfaces.size(), 1u);
  EXPECT_NEAR(surfaces[0].offset_m, 0.5e-3, 0.02e-3);
  const auto model = test::fit(prepared, &kRandomMethod);
  const ModelData back = test::must(read_model_text(test::must(write_model_text(model->data())), "m.json"));
  ASSERT_EQ(back.provenance.surfaces.size(), 1u);
  EXPECT_EQ(back.provenance.surfaces[0].offset_m, surfaces[0].offset_m);
  EXPECT_EQ(back.provenance.surfaces[0].standard_error_m, surfaces[0].standard_error_m);
  EXPECT_EQ(back.provenance.surfaces[0].force_zero_N, surfaces[0].force_zero_N);
}

// What one rig records, its model gives back where that rig has it.
TEST(SurfaceRegistration, AModelTouchesWhereItsRecordingsDo) {
  const auto depth_zero = [](const std::vector<RecordingPtr>& recordings) {
    return surface_position_m(test::prepare(recordings, test::scene_request("silicone_block")).common.features);
  };
  EXPECT_NEAR(depth_zero({rig("maxwell", 2, 0.5e-3)}), 0.5e-3, 0.02e-3);
  // Of several the first to be met.
  EXPECT_NEAR(depth_zero({rig("maxwell", 1, 0.8e-3), rig("maxwell", 2, 0.5e-3)}), 0.5e-3, 0.03e-3);
  EXPECT_EQ(depth_zero({rig("maxwell", 1), rig("maxwell", 2, 0.5e-3)}), 0.0);
  EXPECT_EQ(depth_zero({rig("maxwell", 2, -0.5e-3)}), 0.0) << "the tool is in contact at 0";

  // Share within the JND of another recording of the same rig, as recorded.
  const auto within_jnd = [](double offset_m) {
    const RecordingPtr next = rig("silicone", 2, offset_m);
    const auto model =
        test::fit(test::prepare({rig("silicone", 1, offset_m)}, test::scene_request("silicone_block")), &kRandomMethod);
    ErrorStatistics errors(model->data().jnd);
    test::must(replay(*next, {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
      if (row.position_m > offset_m) errors.add(snapshot.force_N[0], row.force_N, false);
    }));
    return errors.summary().within_jnd;
  };
  // A shift that is found to 0.02 mm costs no more.
  EXPECT_NEAR(within_jnd(0.6e-3), within_jnd(0.0), 0.005);
}

// A press that never lets go does not say where it would begin.
TEST(SurfaceRegistration, AnOnsetThatWasNotSeenMovesNothing) {
  RigSettings settings = test::train_settings("maxwell");
  settings.seconds = 12.0;
  Recording pressed = *test::rig_recording(settings);
  for (RecordingRow& row : pressed.rows) {
    // An elastic block, from 1.2 mm to 3.2 mm and back.
    const double phase = 2.0 * std::numbers::pi * row.time_s;
    row.position_m = 2.2e-3 - 1e-3 * std::cos(phase);
    row.force_N = 400.0 * (row.position_m - 0.9e-3);
  }
  const SurfaceEstimate own = estimate_surface(pressed);
  EXPECT_NEAR(own.offset_m, 0.9e-3, 0.1e-3) << "where a straight line would begin";
  EXPECT_FALSE(own.onset_seen);
  const auto surfaces = registered({std::make_shared<Recording>(pressed)});
  EXPECT_EQ(surfaces[0].offset_m, 0.0);
}

// A recording that was shifted gives the model of the one that was not, but for
// what is left of the shift.
TEST(SurfaceRegistration, RecordedSwitchesItOff) {
  TrainingRequest request = test::scene_request("silicone_block");
  request.surface = Surface::recorded;
  const RecordingPtr shifted = rig("maxwell", 2, 0.5e-3);
  const auto prepared = test::prepare({shifted}, request);
  EXPECT_TRUE(prepared.common.provenance.surfaces.empty());
  const auto registered = test::prepare({shifted}, test::scene_request("silicone_block"));
  EXPECT_NEAR(prepared.common.upper(0) - registered.common.upper(0), 0.5e-3, 0.02e-3);
}

}  // namespace
}  // namespace palpate
