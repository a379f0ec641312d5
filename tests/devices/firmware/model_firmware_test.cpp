// A paddle that renders a model by itself, on a simulated board.
#include "devices/firmware/standalone/model_firmware.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/tick/jnd.h"
#include "engine/tick/replay.h"
#include "engine/tick/sensor_identification.h"
#include "tests/support/compiled_model.h"
#include "tests/support/example_model.h"

namespace palpate::standalone {
namespace {

class StandaloneBoard {
 public:
  uint32_t now_us() { return time_us; }
  int32_t counts() { return position; }
  uint8_t condition() {
    return static_cast<uint8_t>((bad_motor ? bridge::kMotorFault : 0) | (held ? bridge::kGrip : 0));
  }
  void set_current_mA(int32_t value) { current_mA = value; }

  uint32_t time_us = 4'294'000'000U;  // wraps within the test
  int32_t position = 0;
  bool bad_motor = false, held = true;
  int32_t current_mA = 99;
};

struct Standalone {
  Standalone() {
    settings.metres_per_count = 30e-6F;
    settings.mA_per_N = 200.0F;
  }
  ExportedModel exported() { return {model.force_after, model.reset}; }

  ModelData data = test::example_models().front();
  test::CompiledModel<float> model{data, {true, {30e-6, 0.0}}};
  StandaloneBoard board;
  Settings settings;
};

TEST(ModelFirmware, RendersTheForcesOfReplayAtOneKilohertz) {
  Standalone all;
  ASSERT_NE(all.model.force_after, nullptr);
  ModelFirmware firmware(all.board, all.exported(), all.settings);
  const Recording recording = test::example_recording(2500, 1000.0, 30e-6);
  double worst_over_jnd = 0.0;
  const JndLine jnd;
  std::size_t row = 0;
  const auto summary =
      replay(recording, {std::make_shared<FittedModel>(all.data)},
             [&](const RecordingRow& sample, const TickSnapshot& snapshot, const HapticsTick&) {
               for (int i = 0; i < 10; ++i) {
                 all.board.time_us += 100;
                 if (i == 9) all.board.position = static_cast<int32_t>(std::lround(sample.position_m / 30e-6));
                 firmware.loop();
               }
               worst_over_jnd = std::max(worst_over_jnd, jnd.error_over_jnd(firmware.force_N(), snapshot.force_N[0]));
               // After the ramp the current is the force's, to one mA.
               if (++row > 400) {
                 EXPECT_NEAR(all.board.current_mA, std::max(-1000.0, -200.0 * snapshot.force_N[0]), 1.5);
               }
             });
  EXPECT_TRUE(summary.ok());
  EXPECT_LT(worst_over_jnd, 0.05);
  EXPECT_EQ(firmware.missed(), 0U);
}

TEST(ModelFirmware, DrivesNothingWithoutTheGripAndAfterAFault) {
  Standalone all;
  ASSERT_NE(all.model.force_after, nullptr);
  ModelFirmware firmware(all.board, all.exported(), all.settings);
  const auto run_ms = [&](int span) {
    for (int i = 0; i < span; ++i) {
      all.board.time_us += 1000;
      firmware.loop();
    }
  };
  run_ms(5);
  all.board.position = 100;  // 3 mm inside
  run_ms(10);
  const int32_t ramping_mA = all.board.current_mA;
  run_ms(600);
  EXPECT_LT(all.board.current_mA, ramping_mA);
  EXPECT_LT(all.board.current_mA, -50);
  all.board.held = false;
  run_ms(1);
  EXPECT_EQ(all.board.current_mA, 0);
  all.board.held = true;
  run_ms(400);
  EXPECT_LT(all.board.current_mA, -50);
  all.board.bad_motor = true;
  run_ms(1);
  all.board.bad_motor = false;
  run_ms(500);
  EXPECT_EQ(all.board.current_mA, 0) << "a fault stays until the grip was let go";
  EXPECT_TRUE(firmware.fault());
  all.board.held = false;
  run_ms(1);
  all.board.held = true;
  run_ms(500);
  EXPECT_LT(all.board.current_mA, -50);
}

TEST(ModelFirmware, CountsWhatItMissedAndGoesOn) {
  Standalone all;
  ASSERT_NE(all.model.force_after, nullptr);
  ModelFirmware firmware(all.board, all.exported(), all.settings);
  all.board.time_us += 5000;
  firmware.loop();
  EXPECT_EQ(firmware.missed(), 1U);
  all.board.time_us += 1000;
  firmware.loop();
  EXPECT_EQ(firmware.missed(), 1U);
}

}  // namespace
}  // namespace palpate::standalone
