#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/tick/replay.h"
#include "models/model/file/model_io.h"
#include "scenes/evaluation/model_errors.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

using test::RecordingPtr;

RecordingPtr rig(const std::string& material, std::uint64_t seed, double offset_m = 0.0) {
  RigSettings settings = test::train_settings(material);
  settings.seed = seed;
  settings.seconds = 12.0 + static_cast<double>(seed);
  auto copy = std::make_shared<Recording>(*test::rig_recording(settings));
  for (RecordingRow& row : copy->rows) row.position_m += offset_m;
  return copy;
}

TEST(PrepareOnTheForce, FitsTwoTimesToTheRecording) {
  const test::FitRequest request = test::on_the_force(test::default_request("silicone_block"));
  RigSettings settings = test::train_settings("foam");  // 0.08 and 0.9 s, unlike the times of the scene
  settings.seconds = 15.0;
  const PreparedTraining prepared = test::prepare({test::rig_recording(settings)}, request);
  const std::vector<double> times_s = relaxation_times_s(prepared.common.features);
  ASSERT_EQ(times_s.size(), 2u);
  EXPECT_LT(times_s[0], times_s[1]);
  EXPECT_NE(times_s, relaxation_times_s(request.scene.features));
  std::size_t low_pass = 0;
  for (const FeatureSpec& spec : prepared.common.features) low_pass += spec.kind == FeatureKind::lowpass_velocity;
  EXPECT_EQ(low_pass, 2u);
  const Provenance& provenance = prepared.common.provenance;
  EXPECT_EQ(provenance.thinning, "force");
  EXPECT_EQ(provenance.weighting, "relative");
  EXPECT_EQ(provenance.relaxation, "auto");
}

// The paper's low-passes take the place of Maxwell branches.
TEST(PrepareOnTheForce, AListGivesItsRelaxationTimes) {
  test::FitRequest request = test::on_the_force(test::default_request("silicone_block"));
  request.plan.features = FeatureChoice::given;
  request.plan.list = test::must(parse_feature_list("velocity,maxwell:0.17,maxwell:0.4+1.27"));
  RigSettings settings = test::train_settings("silicone");
  settings.seconds = 8.0;
  const PreparedTraining prepared = test::prepare({test::rig_recording(settings)}, request);
  EXPECT_EQ(relaxation_times_s(prepared.common.features), (std::vector{0.17, 0.4, 1.27}));
  ASSERT_EQ(prepared.common.features.size(), 5u);
  EXPECT_EQ(prepared.common.features[1].kind, FeatureKind::velocity);
  EXPECT_EQ(prepared.common.features[4].kind, FeatureKind::lowpass_velocity);
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
TEST(PrepareTraining, FrequenciesOfAPorousSolidAreNoOffsets) {
  const std::vector<RecordingPtr> recordings{porous_presses(0.2, 4e-3, 20.0), porous_presses(1.0, 4e-3, 10.0),
                                             porous_presses(0.5, 2e-3, 10.0)};
  const PreparedTraining prepared = test::prepare(recordings, test::default_request("silicone_block"));
  for (const auto& offset : prepared.common.provenance.offsets) EXPECT_EQ(offset.offset_m, 0.0) << offset.name;
  const test::ModelPtr model = test::fit(prepared, &kTrendMethod);
  // 0.84; with offsets of some tenths of a millimetre 0.68.
  EXPECT_GT(test::judge(*porous_presses(0.4, 3.5e-3, 15.0), model).within_jnd, 0.8);
}

std::string model_of(const std::vector<RecordingPtr>& recordings, const Method* method) {
  const auto model = test::fit(test::prepare(recordings, test::scene_request("silicone_block")), method);
  return test::must(write_model_text(model->data()));
}

TEST(PrepareTraining, TheOrderOfRecordingsChangesNoByteOfTheModel) {
  const RecordingPtr a = rig("silicone", 1);
  const RecordingPtr b = rig("silicone", 2, 2e-3);
  const RecordingPtr c = rig("foam", 2, -0.1e-3);
  const std::string model = model_of({a, b, c}, &kKdTreeMethod);
  EXPECT_EQ(model_of({c, a, b}, &kKdTreeMethod), model);
  EXPECT_EQ(model_of({b, c, a}, &kKdTreeMethod), model);
}

TEST(PrepareTraining, ASiteCountsAsItsSamplesAndAModelSaysWhereItsRecordingsWere) {
  const auto prepared =
      test::prepare({rig("maxwell", 2, 0.5e-3), rig("maxwell", 3)}, test::scene_request("silicone_block"));
  EXPECT_GT(prepared.sites.samples.maxCoeff(), 16.0);
  for (Eigen::Index i = 0; i < prepared.sites.count(); ++i) {
    const double samples = std::min(prepared.sites.samples(i), 16.0);
    EXPECT_DOUBLE_EQ(prepared.sites.row_scale(i), std::sqrt(samples) / JndLine{}.at(prepared.sites.force_N(i)));
  }
  const auto& offsets = prepared.common.provenance.offsets;
  ASSERT_EQ(offsets.size(), 2u);
  // The accuracy of each surface is 0.02 mm.
  EXPECT_NEAR(offsets[1].offset_m - offsets[0].offset_m, 0.5e-3, 0.05e-3);
  const auto model = test::fit(prepared, &kRandomMethod);
  const ModelData back = test::must(read_model_text(test::must(write_model_text(model->data())), "m.json"));
  ASSERT_EQ(back.provenance.offsets.size(), 2u);
  EXPECT_EQ(back.provenance.offsets[1].offset_m, offsets[1].offset_m);
  EXPECT_EQ(back.provenance.offsets[1].standard_error_m, offsets[1].standard_error_m);
  EXPECT_EQ(back.provenance.offsets[1].force_zero_N, offsets[1].force_zero_N);
}

// Two recordings with the same name: each has its own offset.
TEST(PrepareTraining, OffsetsAreKnownByTheContentOfTheirRecordings) {
  std::vector<RecordingPtr> recordings;
  for (const double offset_m : {0.5e-3, 0.0}) {
    Recording one = *rig("maxwell", recordings.empty() ? 2 : 3, offset_m);
    one.name = "press";
    recordings.push_back(std::make_shared<const Recording>(std::move(one)));
  }
  const auto prepared = test::prepare(recordings, test::scene_request("silicone_block"));
  double offsets_m[2] = {NAN, NAN};
  for (const RecordingOffset& offset : prepared.common.provenance.offsets) {
    for (std::size_t i = 0; i < 2; ++i)
      if (offset.content_hash == content_hash(*recordings[i])) offsets_m[i] = offset.offset_m;
  }
  EXPECT_NEAR(offsets_m[0] - offsets_m[1], 0.5e-3, 0.05e-3);
}

// The forces of a model of recordings with a common offset are those of a model of the same recordings without it, at
// positions that are moved by the offset.
TEST(PrepareTraining, AModelTouchesWhereItsRecordingsDo) {
  const auto within_jnd = [](double offset_m) {
    const RecordingPtr next = rig("silicone", 2, offset_m);
    const auto model =
        test::fit(test::prepare({rig("silicone", 1, offset_m)}, test::scene_request("silicone_block")), &kRandomMethod);
    EXPECT_NEAR(surface_position_m(model->data().features), offset_m, 0.1e-3);
    ModelErrors errors(model->data().jnd);
    replay(*next, {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
      if (row.position_m > offset_m) errors.add(snapshot.force_N[0], row.force_N, false);
    });
    return errors.summary().within_jnd;
  };
  // An error of 0.05 mm in the offset changes the share only slightly.
  const double in_place = within_jnd(0.0);
  EXPECT_GT(in_place, 0.9);
  for (const double shift_m : {-12e-3, 0.6e-3, 12e-3}) EXPECT_NEAR(within_jnd(shift_m), in_place, 0.01) << shift_m;
}

}  // namespace
}  // namespace palpate
