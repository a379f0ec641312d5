// A bridge device and the host, in simulated time: every fault sets the force to zero, and
// the force returns with a ramp when the fault ends.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/message_parts.h"
#include "tests/support/simulated_device.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::Report;
using test::SimulatedDevice;

// The change of force by the tremor in one tick.
constexpr double kResolution_N = 0.1;

struct Injection {
  const char* name;
  void (*inject)(SimulatedDevice&);
  std::uint32_t fault;
  double within_s;  // time limit for the force to be zero
};

// Every second report comes after its successor.
auto out_of_order() {
  return [last = Report()](const Report& report) mutable {
    if (!last.empty()) return test::Reports{report, std::exchange(last, {})};
    last = report;
    return test::Reports{};
  };
}

const std::vector<Injection>& injections() {
  using namespace device_fault;
  static const std::vector<Injection> all = {
      {"the port or the program is gone", [](SimulatedDevice& s) { s.unplug(); }, kUnplugged, 0.0205},
      {"frames fail to come", [](SimulatedDevice& s) { s.on_the_way_in = test::lost; }, kLate, 0.0205},
      {"the position stands still although the motor pushes (`stuck_after_s`)",
       [](SimulatedDevice& s) { s.encoder_frozen = true; }, kStuck, 0.53},
      {"the same frame comes again and again", [](SimulatedDevice& s) { s.on_the_way_in = test::first_again(); }, kLate,
       0.0205},
      {"frames come 30 ms late", [](SimulatedDevice& s) { s.on_the_way_in = test::late_by(30); }, kLate, 0.0205},
      {"frames come out of order", [](SimulatedDevice& s) { s.on_the_way_in = out_of_order(); }, kOutOfOrder, 0.0205},
      {"a wrong checksum",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report[13] ^= 0x5A; }); },
       kCorrupt, 0.0205},
      {"another version",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report[2] = 9; }); },
       kWrongFirmware, 0.0205},
      {"the device reports a motor fault", [](SimulatedDevice& s) { s.board().conditions = bridge::kMotorFault; }, kOwn,
       0.0205},
      {"the position jumps by 50 mm", [](SimulatedDevice& s) { s.counts_offset = 50'000'000; }, kJump, 0.0205},
      {"the device starts again", [](SimulatedDevice& s) { s.model->restart(); }, kReset | kOutOfOrder, 0.0205},
      {"commands cannot be written", [](SimulatedDevice& s) { s.writer_hangs = true; }, kWriteStalled, 0.0705},
      {"the device confirms no command", [](SimulatedDevice& s) { s.on_the_way_out = [](Report&) { return false; }; },
       kWriteStalled, 0.0705},
      {"its clock is set back by 10 ms", [](SimulatedDevice& s) { s.board().clock_offset_us -= 10'000; }, kReset,
       0.0205},
  };
  return all;
}

void press(SimulatedDevice& simulated) {
  simulated.run_s(0.2);
  simulated.rest = false;
  simulated.run_s(1.0);
}

double wanted_N(const SimulatedDevice& simulated) { return simulated.spring_N(simulated.snapshot.tick.position_m); }

TEST(BridgeEndpoint, PushesWithoutZeroingAndMeasuresForce) {
  SimulatedDevice simulated(&kBridgeProtocol);
  press(simulated);
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::not_needed);
  EXPECT_EQ(simulated.snapshot.device.faults, 0u);
  EXPECT_NEAR(simulated.snapshot.tick.position_m, simulated.position_m(), 30e-6);
  EXPECT_NEAR(simulated.motor_N(), wanted_N(simulated), kResolution_N);
  EXPECT_LT(simulated.model->force_units(), 0.0) << "out of the block";
  EXPECT_EQ(simulated.snapshot.measured_N, 0.25);
  EXPECT_GT(simulated.snapshot.device.round_trip_s, 0.0);
  EXPECT_NEAR(simulated.snapshot.device.interval_s, 1e-3, 1e-4);
}

// The number of ticks (ms) until the force is above 0 (`pushes`) or 0. `most` if that does not happen.
int ticks_until(SimulatedDevice& simulated, bool pushes, int most, std::uint32_t& faults) {
  for (int ticks = 1; ticks < most; ++ticks) {
    simulated.tick();
    faults |= simulated.snapshot.device.faults;
    if ((simulated.snapshot.rendered_N > 0.0) == pushes) return ticks;
  }
  return most;
}

// Uses the shipped calibration. devices/README.md contains the table that this test prints.
TEST(BridgeEndpoint, EveryFaultRemovesTheForceUntilTheTimeInTheReadme) {
  const std::string source = PALPATE_SOURCE_DIR;
  const auto calibration = read_calibration(source + "/assets/devices", kBridgeProtocol);
  ASSERT_TRUE(calibration.ok());
  std::string table = "| what happens | force 0 after [ms] | comes back after its end [ms] |\n|---|---:|---:|\n";
  for (const Injection& injection : injections()) {
    SimulatedDevice simulated(*calibration);
    press(simulated);
    ASSERT_GT(simulated.snapshot.rendered_N, 2.0) << injection.name;
    std::uint32_t faults = 0;
    injection.inject(simulated);
    const int to_zero = ticks_until(simulated, false, 6000, faults);
    for (int i = 0; i < 50; ++i) faults |= simulated.tick().device.faults;
    EXPECT_NE(faults & injection.fault, 0u) << injection.name;
    EXPECT_LE(1e-3 * to_zero,
              injection.fault == device_fault::kStuck ? calibration->stuck_after_s + 0.03 : injection.within_s)
        << injection.name;

    simulated.mend();
    simulated.counts_offset = 0;
    simulated.board().conditions = 0;
    const int back = ticks_until(simulated, true, 1000, faults);
    EXPECT_LE(back, 300) << injection.name;
    EXPECT_LT(simulated.snapshot.rendered_N, 0.2) << injection.name << ": with a ramp";
    simulated.run_s(1.2);
    EXPECT_EQ(simulated.snapshot.device.faults, 0u) << injection.name;
    table +=
        std::string("| ") + injection.name + " | " + std::to_string(to_zero) + " | " + std::to_string(back) + " |\n";
  }
  std::printf("%s", table.c_str());
  EXPECT_TRUE(test::has_parts(test::read_text(source + "/devices/README.md"), {table}))
      << "put the table above into devices/README.md";
}

TEST(BridgeEndpoint, RunsFromOneHundredToTenThousandSamplesASecond) {
  for (const std::uint32_t period_us : {10'000u, 2'000u, 1'000u, 250u, 100u}) {
    SimulatedDevice simulated(&kBridgeProtocol);
    simulated.step_us = period_us < 250 ? 50 : 250;
    simulated.board().period_us = period_us;
    press(simulated);
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
  press(simulated);
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
  press(simulated);
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
  press(simulated);
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
