#include "models/surface/surface_registration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/recording/recording.h"
#include "engine/tick/replay.h"
#include "models/check/force_lag.h"
#include "models/model/file/model_io.h"
#include "models/samples/surface_estimate.h"
#include "scenes/evaluation/model_errors.h"
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

RegisteredSurfaces registered(const std::vector<RecordingPtr>& recordings) {
  std::vector<PreparedRecordingPointer> prepared;
  for (const RecordingPtr& recording : recordings) prepared.push_back(prepare_recording(*recording));
  MotionSource source(std::move(prepared));
  return test::must(register_surfaces(source, JndLine{}));
}

// A MotionSource orders recordings by length: seed 3, 2, 1.
TEST(SurfaceRegistration, FindsEveryShiftAndZeroOfASet) {
  for (const double shift_m : {-4e-3, 4e-3}) {
    const auto surfaces =
        registered({rig("maxwell", 1), rig("maxwell", 2, shift_m, -0.05), rig("maxwell", 3)}).recordings;
    ASSERT_EQ(surfaces.size(), 3u);
    EXPECT_EQ(surfaces[0].offset_m, 0.0) << shift_m;
    EXPECT_NEAR(surfaces[1].offset_m, shift_m, 0.1e-3) << shift_m;
    EXPECT_EQ(surfaces[2].offset_m, 0.0) << shift_m;
    EXPECT_NEAR(surfaces[1].force_zero_N, -0.05, 1e-3) << shift_m;
    EXPECT_EQ(surfaces[0].force_zero_N, 0.0) << shift_m;
  }
}

TEST(SurfaceRegistration, InventsNothing) {
  for (const Material& material : materials()) {
    const std::string name(material.name);
    const RegisteredSurfaces found = registered({rig(name, 4), rig(name, 5)});
    EXPECT_EQ(found.surface_position_m, 0.0) << name;
    for (const RecordingOffset& surface : found.recordings) {
      EXPECT_EQ(surface.lag_s, 0.0) << name;
      EXPECT_EQ(surface.offset_m, 0.0) << name;
      EXPECT_EQ(surface.force_zero_N, 0.0) << name;
    }
  }
}

// Two ramps of a quasi-linear material (Fung 1993), at 2 and 50 mm/s. The fast one is stiffer. A
// surface offset could explain that, but force starts at 0 in both.
TEST(SurfaceRegistration, TwoSpeedsAreNotAShift) {
  const auto pressed = [](double speed_m_per_s) {
    auto recording = std::make_shared<Recording>();
    constexpr std::array kTimes_s{0.05, 0.5, 5.0};
    std::array<double, 3> held_N{};
    double before_N = 0.0;
    const double way_s = 7e-3 / speed_m_per_s;
    for (double t = 0.0; t < 2.0 * way_s + 1.0; t += 1e-3) {
      const double at = std::clamp(t - 0.5, 0.0, 2.0 * way_s);
      const double z = -1e-3 + speed_m_per_s * std::min(at, 2.0 * way_s - at);
      const double depth = std::max(0.0, z);
      const double elastic_N = 120.0 * depth + 4e4 * depth * depth;
      double force_N = elastic_N;
      for (std::size_t k = 0; k < held_N.size(); ++k) {
        held_N[k] = held_N[k] * std::exp(-1e-3 / kTimes_s[k]) + 0.3 * (elastic_N - before_N);
        force_N += held_N[k];
      }
      before_N = elastic_N;
      RecordingRow row;
      row.time_s = t;
      row.position_m = z;
      // Pseudo-noise of 2 mN.
      row.force_N = (z > 0.0 ? std::max(0.0, force_N) : 0.0) + 2e-3 * std::sin(977.0 * t * t + 12.9 * t);
      recording->rows.push_back(row);
    }
    return recording;
  };
  const RegisteredSurfaces found = registered({pressed(2e-3), pressed(50e-3)});
  for (const RecordingOffset& surface : found.recordings) EXPECT_EQ(surface.offset_m, 0.0);
}

// A porous solid under cyclic presses: the pressure of its fluid relaxes within times of 4 s / (2 n + 1)^2, and acts on
// an area that grows with the depth, so that contact is lost while the tool retreats.
RecordingPtr porous_presses(double frequency_per_s, double depth_m, double seconds) {
  auto recording = std::make_shared<Recording>();
  recording->name = "porous " + std::to_string(frequency_per_s);
  std::array<double, 8> pressure_m{};
  double last_m = 0.0;
  for (int i = 0; 2e-3 * i < seconds; ++i) {
    const double time_s = 2e-3 * i;
    const double position_m =
        -0.5e-3 + (depth_m + 0.5e-3) * 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * frequency_per_s * time_s));
    const double x_m = std::max(0.0, position_m);
    double sum_m = 0.0;
    for (std::size_t n = 0; n < pressure_m.size(); ++n) {
      const double odd = 2.0 * static_cast<double>(n) + 1.0;
      const double share = 8.0 / (std::numbers::pi * std::numbers::pi * odd * odd);
      pressure_m[n] = pressure_m[n] * std::exp(-2e-3 * odd * odd / 4.0) + share * (x_m - last_m);
      sum_m += pressure_m[n];
    }
    last_m = x_m;
    const double force_N = 800.0 * x_m * (1.0 + 200.0 * x_m) + 2000.0 * sum_m * (1.0 + 150.0 * x_m);
    // Pseudo-noise of 8 mN.
    const double noise_N = 11e-3 * std::sin(977.0 * time_s * time_s + 12.9 * time_s);
    recording->rows.push_back(
        {time_s, position_m, (position_m > 0.0 ? std::max(0.0, force_N) : 0.0) + noise_N, 0.0, 0.0});
  }
  return recording;
}

// The faster a press, the stiffer the solid: no offset explains that.
TEST(SurfaceRegistration, FrequenciesOfAPorousSolidAreNoOffsets) {
  const std::vector<RecordingPtr> recordings{porous_presses(0.2, 4e-3, 20.0), porous_presses(1.0, 4e-3, 10.0),
                                             porous_presses(0.5, 2e-3, 10.0)};
  const PreparedTraining prepared = test::prepare(recordings, test::default_request("silicone_block"));
  for (const auto& surface : prepared.common.provenance.offsets) EXPECT_EQ(surface.offset_m, 0.0) << surface.name;
  const test::ModelPtr model = test::fit(prepared, find_method("trend"));
  // 0.84; with the offsets 0.68.
  EXPECT_GT(test::judge(*porous_presses(0.4, 3.5e-3, 15.0), model).within_jnd, 0.8);
}

// An offset common to all recordings, of either sign, is the surface of the model. No recording is moved.
TEST(SurfaceRegistration, ACommonShiftIsTheModelsSurface) {
  for (const double shift_m : {-0.55e-3, 0.55e-3}) {
    const RegisteredSurfaces found = registered({rig("maxwell", 1, shift_m), rig("maxwell", 2, shift_m)});
    EXPECT_NEAR(found.surface_position_m, shift_m, 0.05e-3);
    for (const RecordingOffset& surface : found.recordings) EXPECT_EQ(surface.offset_m, 0.0);
    EXPECT_NEAR(registered({rig("maxwell", 1, shift_m)}).surface_position_m, shift_m, 0.05e-3);
  }
}

TEST(SurfaceRegistration, ALagThatTheRecordingsShareIsTheRigs) {
  const auto late = [](std::uint64_t seed) {
    auto copy = std::make_shared<Recording>(*rig("foam", seed));
    std::vector<SurfaceRow> rows = without_lag(thinned_rows(*copy, kAllRows), -10e-3);
    copy->rows.erase(copy->rows.begin(), copy->rows.end() - static_cast<std::ptrdiff_t>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) copy->rows[i].force_N = rows[i].force_N;
    return RecordingPtr(copy);
  };
  EXPECT_NEAR(registered({late(1), late(2)}).recordings[0].lag_s, 10e-3, 2e-3);
  // The trend confirms it.
  const PreparedTraining prepared = test::prepare({late(1), late(2)}, test::default_request("silicone_block"));
  for (const auto& surface : prepared.common.provenance.offsets) EXPECT_NEAR(surface.lag_s, 10e-3, 2e-3);
}

// A press from 1.2 mm to 3.2 mm and back, always in contact.
RecordingPtr pressed(double seconds, double shift_m) {
  auto recording = std::make_shared<Recording>();
  recording->name = "pressed";
  for (int i = 0; i < static_cast<int>(500.0 * seconds); ++i) {
    const double depth_m = 2.2e-3 - 1e-3 * std::cos(0.012 * i);
    recording->rows.push_back({2e-3 * i, depth_m + shift_m, 4e5 * depth_m * depth_m, 0.0, 0.0});
  }
  return recording;
}

TEST(SurfaceRegistration, WithoutFreeAirOnlyWhatIsRelativeIsTold) {
  const RegisteredSurfaces one = registered({pressed(12.0, 0.0)});
  EXPECT_EQ(one.recordings[0].offset_m, 0.0);
  EXPECT_EQ(one.recordings[0].force_zero_N, 0.0);
  EXPECT_TRUE(std::isinf(one.recordings[0].standard_error_m));
  EXPECT_EQ(one.surface_position_m, 0.0);
  const auto two = registered({pressed(12.0, 0.0), pressed(10.0, 3e-3)}).recordings;
  EXPECT_NEAR(two[1].offset_m - two[0].offset_m, 3e-3, 0.1e-3);
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

TEST(SurfaceRegistration, AModelSaysWhereItsRecordingsWere) {
  const auto prepared =
      test::prepare({rig("maxwell", 2, 0.5e-3), rig("maxwell", 3)}, test::scene_request("silicone_block"));
  const auto& surfaces = prepared.common.provenance.offsets;
  ASSERT_EQ(surfaces.size(), 2u);
  // Either of the two may be moved.
  EXPECT_NEAR(surfaces[1].offset_m - surfaces[0].offset_m, 0.5e-3, 0.1e-3);
  const auto model = test::fit(prepared, &kRandomMethod);
  const ModelData back = test::must(read_model_text(test::must(write_model_text(model->data())), "m.json"));
  ASSERT_EQ(back.provenance.offsets.size(), 2u);
  EXPECT_EQ(back.provenance.offsets[1].offset_m, surfaces[1].offset_m);
  EXPECT_EQ(back.provenance.offsets[1].standard_error_m, surfaces[1].standard_error_m);
  EXPECT_EQ(back.provenance.offsets[1].force_zero_N, surfaces[1].force_zero_N);
}

// Two recordings with the same name: each has its own offset.
TEST(SurfaceRegistration, SurfacesAreKnownByTheContentOfTheirRecordings) {
  std::vector<RecordingPtr> recordings;
  for (const double offset_m : {0.5e-3, 0.0}) {
    Recording one = *rig("maxwell", recordings.empty() ? 2 : 3, offset_m);
    one.name = "press";
    recordings.push_back(std::make_shared<const Recording>(std::move(one)));
  }
  const auto prepared = test::prepare(recordings, test::scene_request("silicone_block"));
  double offsets_m[2] = {NAN, NAN};
  for (const RecordingOffset& surface : prepared.common.provenance.offsets) {
    for (std::size_t i = 0; i < 2; ++i)
      if (surface.content_hash == content_hash(*recordings[i])) offsets_m[i] = surface.offset_m;
  }
  EXPECT_NEAR(offsets_m[0] - offsets_m[1], 0.5e-3, 0.1e-3);
  EXPECT_NEAR(offsets_m[0] + offsets_m[1], 0.0, 1e-9) << "the median of two is in their middle";
}

// A model of recordings with a common offset has its surface at that offset.
TEST(SurfaceRegistration, AModelTouchesWhereItsRecordingsDo) {
  const auto within_jnd = [](double offset_m) {
    const RecordingPtr next = rig("silicone", 2, offset_m);
    const auto model =
        test::fit(test::prepare({rig("silicone", 1, offset_m)}, test::scene_request("silicone_block")), &kRandomMethod);
    ModelErrors errors(model->data().jnd);
    replay(*next, {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
      if (row.position_m > offset_m) errors.add(snapshot.force_N[0], row.force_N, false);
    });
    return errors.summary().within_jnd;
  };
  // An error of 0.05 mm in the offset changes the share only slightly.
  for (const double shift_m : {-0.6e-3, 0.6e-3}) EXPECT_NEAR(within_jnd(shift_m), within_jnd(0.0), 0.01) << shift_m;
}

TEST(SurfaceRegistration, RecordedSwitchesItOff) {
  TrainingRequest request = test::scene_request("silicone_block");
  request.surface = Surface::recorded;
  const auto prepared = test::prepare({rig("maxwell", 2, 0.5e-3)}, request);
  EXPECT_TRUE(prepared.common.provenance.offsets.empty());
  EXPECT_EQ(surface_position_m(prepared.common.features), 0.0);
}

}  // namespace
}  // namespace palpate
