// A bridge device and the host, in simulated time: every rate of samples, and the grip. Its faults are in
// device_endpoint_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"
#include "tests/support/simulated_device.h"

namespace palpate {
namespace {

using test::Report;
using test::SimulatedDevice;

// The change of force by the tremor in one tick.
constexpr double kResolution_N = 0.1;

double wanted_N(const SimulatedDevice& simulated) { return simulated.spring_N(simulated.snapshot.tick.position_m); }

TEST(BridgeEndpoint, PushesWithoutZeroingAndMeasuresForce) {
  SimulatedDevice simulated(&kBridgeProtocol);
  simulated.press();
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::not_needed);
  EXPECT_EQ(simulated.snapshot.device.faults, 0u);
  EXPECT_NEAR(simulated.snapshot.tick.position_m, simulated.position_m(), 30e-6);
  EXPECT_NEAR(simulated.motor_N(), wanted_N(simulated), kResolution_N);
  EXPECT_LT(simulated.model->force_units(), 0.0) << "out of the block";
  EXPECT_EQ(simulated.snapshot.measured_N, 0.25);
  EXPECT_NEAR(simulated.snapshot.delay_ms, 1.5F, 0.5F);
  EXPECT_NEAR(simulated.snapshot.device.interval_s, 1e-3, 1e-4);
}

TEST(BridgeEndpoint, RunsFromOneHundredToTenThousandSamplesASecond) {
  for (const std::uint32_t period_us : {10'000u, 2'000u, 1'000u, 250u, 100u}) {
    SimulatedDevice simulated(&kBridgeProtocol);
    simulated.step_us = period_us < 250 ? 50 : 250;
    simulated.board().period_us = period_us;
    simulated.press();
    EXPECT_EQ(simulated.snapshot.device.faults, 0u) << period_us;
    EXPECT_NEAR(simulated.snapshot.rendered_N, wanted_N(simulated), kResolution_N) << period_us;
    EXPECT_NEAR(simulated.snapshot.device.interval_s, 1e-6 * period_us, 0.1e-6 * period_us);
    std::uint32_t samples = 0;
    for (int i = 0; i < 100; ++i) samples += simulated.tick().samples;
    EXPECT_NEAR(samples, 1e5 / period_us, 1.0) << "every one is handed over";
  }
}

TEST(BridgeEndpoint, FramesThatComeTwiceDoNoHarm) {
  SimulatedDevice simulated(&kBridgeProtocol);
  simulated.on_the_way_in = [](const Report& report) { return test::Reports{report, report}; };
  simulated.press();
  EXPECT_EQ(simulated.snapshot.device_faults_latched & (device_fault::kOutOfOrder | device_fault::kCorrupt), 0u);
  EXPECT_NEAR(simulated.motor_N(), wanted_N(simulated), kResolution_N);
}

// Random sample periods from 10 kHz to 200 Hz, for half a second.
TEST(BridgeEndpoint, IrregularSamplesAreAllHandedOverAndNoFault) {
  SimulatedDevice simulated(&kBridgeProtocol);
  simulated.step_us = 50;
  test::BridgeModel& model = simulated.board();
  RandomStream random(3, 0);
  model.next_period_us = [&random] {
    return static_cast<std::uint32_t>(std::lround(100.0 * std::pow(50.0, random.uniform(0.0, 1.0))));
  };
  simulated.press();
  const std::uint32_t sent_before = model.samples;
  std::uint32_t samples = 0, faults = 0;
  for (int i = 0; i < 500; ++i) {
    samples += simulated.tick().samples;
    faults |= simulated.snapshot.device.faults;
    EXPECT_GT(simulated.snapshot.rendered_N, 3.0) << i;
  }
  EXPECT_EQ(faults, 0u);
  EXPECT_NEAR(samples, model.samples - sent_before, 10.0) << "but those on their way";
  EXPECT_NEAR(simulated.motor_N(), wanted_N(simulated), kResolution_N);
}

TEST(BridgeEndpoint, TheGripIsADeadManSwitch) {
  SimulatedDevice simulated(&kBridgeProtocol);
  test::BridgeModel& board = simulated.board();
  simulated.controls.dead_man = DeadMan::grip;
  simulated.press();
  EXPECT_EQ(simulated.motor_N(), 0.0);
  EXPECT_TRUE(simulated.snapshot.dead_man_released);
  board.conditions = bridge::kGrip;
  simulated.run_s(1.0);
  EXPECT_GT(simulated.motor_N(), 3.5);
  board.conditions = 0;
  simulated.run_s(0.02);
  EXPECT_EQ(simulated.motor_N(), 0.0);
}

}  // namespace
}  // namespace palpate
