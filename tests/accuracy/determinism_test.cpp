// The same data and request give bit-identical models, also after saving and
// loading. No fitted model allocates or locks in a tick (tests/support/rt_guard.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/replay.h"
#include "models/model/file/model_io.h"
#include "tests/support/fitting.h"
#include "tests/support/rt_guard.h"
#include "tests/support/temporary_folder.h"

namespace palpate::test {
namespace {

RigSettings short_recording() {
  RigSettings settings = train_settings("silicone");
  settings.seconds = 10.0;
  return settings;
}

// 250 Hz keeps direct fits short.
std::vector<ModelPtr> fitted_anew() {
  RigSettings settings = short_recording();
  settings.rate_Hz = 250.0;
  return fit_all(prepare({rig_recording(settings)}, default_request("silicone_block")));
}

const std::vector<ModelPtr>& fitted() {
  static const std::vector<ModelPtr> models = fitted_anew();
  return models;
}

// All forces of a replay of a recording with another seed.
std::vector<double> forces_of(const std::vector<ModelPtr>& models) {
  RigSettings settings = short_recording();
  settings.seed = 2;
  std::vector<double> forces_N;
  replay(*rig_recording(settings), ForceModels(models.begin(), models.end()),
         [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
           forces_N.insert(forces_N.end(), snapshot.force_N.begin(), snapshot.force_N.begin() + snapshot.model_count);
         });
  return forces_N;
}

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(*std::max_element(a.begin(), a.end()), 1.0) << "the replay presses";
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
}

TEST(Determinism, TheSameFitTwiceGivesTheSameBits) { expect_same_bits(forces_of(fitted()), forces_of(fitted_anew())); }

TEST(Determinism, ASavedModelGivesTheSameBits) {
  const TemporaryFolder folder;
  std::vector<ModelPtr> loaded;
  for (const ModelPtr& model : fitted()) {
    const std::string path = folder.file(model->name() + ".json");
    ASSERT_TRUE(save_model(path, model->data(), false).ok());
    loaded.push_back(must(load_model(path)));
  }
  expect_same_bits(forces_of(fitted()), forces_of(loaded));
}

TEST(Determinism, TenThousandTicksOfFittedModelsOffendNothing) {
  if (!rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  const RecordingPtr recording = rig_recording(short_recording());
  ASSERT_GE(recording->rows.size(), 10000u);
  SensorSpec sensor;
  sensor.encoder_step_m = 30e-6;
  HapticsTick tick(sensor, ForceModels(fitted().begin(), fitted().end()));
  std::size_t in_contact = 0;
  RtGuard guard;
  for (std::size_t i = 0; i < 10000; ++i) {
    const RecordingRow& row = recording->rows[i];
    in_contact += tick.step({row.time_s, row.position_m, 0.0, 0.0}).in_contact ? 1U : 0U;
  }
  const RtOffences offences = guard.stop();
  EXPECT_EQ(offences.total(), 0);
  EXPECT_GT(in_contact, 3000u);
}

}  // namespace
}  // namespace palpate::test
