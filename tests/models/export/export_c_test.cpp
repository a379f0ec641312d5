// The exported C file, compiled with the options of a microcontroller's compiler and
// compared with replay sample by sample.
#include "models/export/export_c.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/motion_estimator.h"
#include "tests/support/compiled_model.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

using test::CompiledModel;
using Compare = std::function<void(const RecordingRow& row, double force_N, bool out_of_domain)>;

SensorSpec positions_of(const Recording& recording) {
  const SensorSpec sensor = identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns);
  return {sensor.encoder_step_m, sensor.position_noise_m};
}

void for_each_force(const Recording& recording, const ModelData& data, const Compare& compare) {
  replay(recording, {std::make_shared<FittedModel>(data)},
         [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
           compare(row, snapshot.force_N[0], (snapshot.out_of_domain_mask & 1U) != 0);
         });
}

const std::vector<Recording>& recordings() {
  static const std::vector<Recording> list = {test::example_recording(4000, 1000.0, 30e-6),
                                              test::example_recording(2000, 700.0)};
  return list;
}

// The first model has a domain of half of the depth, so that deeper presses are out of it.
TEST(ExportC, InDoublePrecisionItGivesReplaysForcesToANanonewton) {
  std::vector<ModelData> models = test::example_models();
  models.front().lower(0) = 0.0;
  models.front().upper(0) = 3e-3;
  int flagged = 0;
  for (const ModelData& data : models) {
    for (const Recording& recording : recordings()) {
      const CompiledModel<double> compiled(data, positions_of(recording));
      ASSERT_TRUE(compiled.loaded());
      double worst_N = 0.0;
      double largest_N = 0.0;
      for_each_force(recording, data, [&](const RecordingRow& row, double force_N, bool out_of_domain) {
        worst_N = std::max(worst_N, std::abs(compiled.force(row.time_s, row.position_m) - force_N));
        largest_N = std::max(largest_N, force_N);
        EXPECT_EQ(compiled.out_of_domain(), out_of_domain ? 1 : 0);
        flagged += out_of_domain && &data == &models.front() ? 1 : 0;
      });
      EXPECT_LT(worst_N, 1e-9) << data.name;
      EXPECT_GT(largest_N, 0.5) << data.name;
    }
  }
  EXPECT_GT(flagged, 100);
}

// Presses, holds and releases with bad sampling: uneven steps of 1 us to a second, repeated
// readings, pauses of up to a day, single outliers.
std::vector<ToolSample> hard_samples(double encoder_step_m, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<ToolSample> samples;
  double t = 0.0;
  double phase = 0.0;
  double typical_s = 1e-3;
  for (int i = 0; i < 6000; ++i) {
    if (share(engine) < 0.003) typical_s = std::pow(10.0, -6.0 * share(engine));
    const double step_s =
        share(engine) < 0.001 ? std::pow(10.0, 4.9 * share(engine)) : typical_s * (0.2 + share(engine));
    t += step_s;
    if (share(engine) < 0.8) phase += 6.0 * std::min(step_s, 0.05);
    double position_m = 2.5e-3 - 3e-3 * std::cos(phase);
    if (encoder_step_m > 0.0) position_m = std::round(position_m / encoder_step_m) * encoder_step_m;
    if (share(engine) < 0.002) position_m += share(engine) < 0.5 ? 0.4 : -1.0;
    samples.push_back({t, position_m, 0.0, 0.0});
  }
  return samples;
}

// One example model for each list of features.
std::vector<ModelData> models_by_features() {
  std::vector<ModelData> some;
  for (ModelData& data : test::example_models()) {
    const auto same = [&](const ModelData& other) { return other.features == data.features; };
    if (std::none_of(some.begin(), some.end(), same)) some.push_back(std::move(data));
  }
  return some;
}

TEST(ExportC, GivesTheLibrarysForcesWhateverTheSteps) {
  for (const double encoder_step_m : {0.0, 1e-6, 30e-6}) {
    for (const ModelData& data : models_by_features()) {
      const SensorSpec sensor{encoder_step_m, 0.0};
      const CompiledModel<double> compiled(data, sensor);
      ASSERT_TRUE(compiled.loaded());
      for (const std::uint64_t seed : {1U, 2U}) {
        HapticsTick tick(sensor, {std::make_shared<FittedModel>(data)});
        compiled.reset();
        for (const ToolSample& sample : hard_samples(encoder_step_m, seed)) {
          const double force_N = tick.step(sample).force_N[0];
          ASSERT_TRUE(std::isfinite(force_N));
          ASSERT_NEAR(compiled.force(sample.time_s, sample.position_m), force_N, 1e-9)
              << data.name << " at " << sample.time_s << " s, seed " << seed << ", encoder " << encoder_step_m;
        }
      }
    }
  }
}

// The limit is the larger of 1 mN and a fiftieth of the JND.
TEST(ExportC, InSinglePrecisionNobodyFeelsTheDifference) {
  const Recording& recording = recordings().front();
  const JndLine jnd;
  for (const ModelData& data : test::example_models()) {
    const CompiledModel<float> compiled(data, positions_of(recording));
    ASSERT_TRUE(compiled.loaded());
    double worst = 0.0;
    for_each_force(recording, data, [&](const RecordingRow& row, double force_N, bool) {
      const double exported_N = compiled.force(row.time_s, static_cast<float>(row.position_m));
      worst = std::max(worst, std::abs(exported_N - force_N) / std::max(1e-3, 0.02 * jnd.at(force_N)));
    });
    EXPECT_LT(worst, 1.0) << data.name;
  }
}

// Bad samples in a row, within and beyond the reach of a hand.
TEST(ExportC, GivesTheLibrarysForcesDuringAndAfterBadSamples) {
  const Recording& recording = recordings().front();
  for (const ModelData& data : models_by_features()) {
    const CompiledModel<double> compiled(data, positions_of(recording));
    ASSERT_TRUE(compiled.loaded());
    HapticsTick tick(positions_of(recording), {std::make_shared<FittedModel>(data)});
    const double bad_m[] = {0.012, 0.05, 0.5, 1e3, -0.5};
    for (std::size_t i = 0; i < recording.rows.size(); ++i) {
      ToolSample sample{recording.rows[i].time_s, recording.rows[i].position_m, 0.0, 0.0};
      if (i % 300 < 2 + i / 300 * 20) sample.position_m = bad_m[i / 300 % std::size(bad_m)];
      ASSERT_NEAR(compiled.force(sample.time_s, sample.position_m), tick.step(sample).force_N[0], 1e-9)
          << data.name << " " << i;
    }
  }
}

TEST(ExportC, ASampleThatIsNoneChangesNothingAndAResetBeginsAgain) {
  const Recording& recording = recordings().front();
  const ModelData data = test::example_models().front();
  const CompiledModel<double> compiled(data, positions_of(recording));
  std::vector<double> forces;
  for (int pass = 0; pass < 2; ++pass) {
    std::size_t i = 0;
    for (const RecordingRow& row : recording.rows) {
      const double force_N = compiled.force(row.time_s, row.position_m);
      if (pass == 0) {
        forces.push_back(force_N);
      } else {
        ASSERT_EQ(force_N, forces[i++]);
      }
      EXPECT_EQ(compiled.force(NAN, row.position_m), 0.0);
      EXPECT_EQ(compiled.force(row.time_s + 1.0, INFINITY), 0.0);
      EXPECT_EQ(compiled.force(row.time_s, 0.001), 0.0);
      EXPECT_EQ(compiled.force_after(0.0, 0.001), 0.0);
    }
    compiled.reset();
  }
}

TEST(ExportC, TheSameModelGivesTheSameBytes) {
  for (const ModelData& data : test::example_models()) EXPECT_EQ(export_c(data, {}), export_c(data, {}));
}

TEST(ExportC, IsRefusedWhereItWouldComputeOtherForces) {
  const test::TemporaryFolder folder;
  const std::string source = folder.with_file("model.c", export_c(test::example_models().front(), {}));
  for (const std::vector<std::string>& options : {std::vector<std::string>{"-ffast-math"},
                                                  {"-ffinite-math-only"},
                                                  {"-U__DBL_MANT_DIG__", "-D__DBL_MANT_DIG__=24"}}) {
    std::vector<std::string> command{PALPATE_C_COMPILER, "-std=c99", "-w", "-fsyntax-only", source};
    EXPECT_EQ(test::run_program(command).exit_code, 0);
    command.insert(command.end() - 1, options.begin(), options.end());
    EXPECT_NE(test::run_program(command).err.find("#error"), std::string::npos) << options.front();
  }
}

TEST(ExportC, ANameCannotLeaveItsComment) {
  ModelData data = test::example_models().front();
  data.name = "a*/ int x; /* \\";
  const CompiledModel<double> compiled(data, {});
  EXPECT_TRUE(compiled.loaded());
}

}  // namespace
}  // namespace palpate
