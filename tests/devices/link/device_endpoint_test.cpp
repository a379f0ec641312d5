// Host and device in simulated time: every fault sets the force to zero, and the
// condition for its return.
#include "devices/link/device_endpoint.h"
#include "devices/hid/hidapi_bus.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/message_parts.h"
#include "tests/support/rt_guard.h"
#include "tests/support/simulated_device.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::Report;
using test::SimulatedDevice;

// The change of force by an encoder step and a tick of tremor.
constexpr double kResolution_N = 0.1;
constexpr const DeviceProtocol* kProtocol = &kOpenFfBoardProtocol;
constexpr const DeviceProtocol* kPushing[] = {&kOpenFfBoardProtocol, &kBridgeProtocol};

TEST(DeviceEndpoint, PushesOnceItIsZeroed) {
  SimulatedDevice simulated(kProtocol);
  simulated.rest = false;
  simulated.run_s(1.0);
  EXPECT_EQ(simulated.motor_N(), 0.0) << "not zeroed";
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::needed);
  EXPECT_EQ(simulated.snapshot.samples, 0u) << "nobody knows where the tool is";
  simulated.press();
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::done);
  EXPECT_EQ(simulated.snapshot.device.faults, 0u);
  EXPECT_NEAR(simulated.snapshot.tick.position_m, simulated.position_m(), 30e-6);
  EXPECT_NEAR(simulated.motor_N(), simulated.spring_N(simulated.position_m()), kResolution_N);
  EXPECT_LT(simulated.model->force_units(), 0.0) << "against the growing counts";
  EXPECT_LT(simulated.snapshot.device.sample_age_s, 2e-3);
  EXPECT_NEAR(simulated.snapshot.delay_ms, 3.25F, 0.5F) << "by its arrivals, because it confirms nothing";
}

TEST(DeviceEndpoint, ZeroingWaitsForRest) {
  SimulatedDevice simulated(kProtocol);
  simulated.device.start_zeroing();
  for (int i = 0; i < 600; ++i) {
    simulated.counts_offset = i;  // 1 m/s / 50
    simulated.tick();
  }
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::hold_still);
  EXPECT_EQ(simulated.motor_N(), 0.0);
  simulated.run_s(0.21);
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::done);
}

TEST(DeviceEndpoint, DirectionTurnsPositionAndForce) {
  DeviceCalibration calibration = test::example_calibration(kProtocol);
  calibration.direction = -1.0;
  DeviceEndpoint endpoint(calibration);
  endpoint.connected(0.0);
  test::OpenFfBoardModel board;
  const auto arrive = [&](std::int32_t counts, double now_s) {
    board.step(0, counts);
    board.be_asked();
    endpoint.report_arrived(board.outbox.back().data(), board.outbox.back().size(), now_s);
  };
  endpoint.start_zeroing();
  double now_s = 0.0;
  for (; now_s < 0.3; now_s += 1e-3) arrive(0, now_s);
  arrive(40, now_s);
  DeviceSample sample;
  ASSERT_TRUE(endpoint.read(now_s, sample));
  EXPECT_TRUE(sample.restart);
  while (endpoint.read(now_s, sample)) EXPECT_FALSE(sample.restart);
  EXPECT_NEAR(sample.tool.position_m, -0.01 - 40.0 / 50000.0, 1e-12);
  endpoint.write(2.0);
  const OutReports out = endpoint.next(now_s);
  ASSERT_GE(out.count, 2u) << "asks for the position, sets the force";
  EXPECT_EQ(wire::read32(out.bytes[1].data() + 9), 6667u);
}

// A disturbance of the stream, and the faults that detect it; 0: not on this device.
struct Injection {
  const char* name;
  void (*inject)(SimulatedDevice&);
  std::uint32_t board, bridge;
  double found_after_s = 0.0;  // the earliest time of detection; kStuck: the time of the calibration
};

// Every second report comes after its successor.
auto out_of_order() {
  return [last = Report()](const Report& report) mutable {
    if (!last.empty()) return test::Reports{report, std::exchange(last, {})};
    last = report;
    return test::Reports{};
  };
}

// Thirty reports at once.
auto burst() {
  return [held = test::Reports()](const Report& report) mutable {
    held.push_back(report);
    return held.size() < 30 ? test::Reports() : std::exchange(held, {});
  };
}

void of_version_9(Report& report) {
  report[2] = 9;
  wire::write32(report.data() + 24, wire::crc32(report.data(), 24));
}

const std::vector<Injection>& injections() {
  using namespace device_fault;
  static const std::vector<Injection> all = {
      {"the port or the program is gone", [](SimulatedDevice& s) { s.unplug(); }, kUnplugged, kUnplugged},
      {"frames fail to come", [](SimulatedDevice& s) { s.on_the_way_in = test::lost; }, kLate, kLate},
      {"the position stands still although the motor pushes (`stuck_after_s`)",
       [](SimulatedDevice& s) { s.encoder_frozen = true; }, kStuck, kStuck},
      {"the same frame comes again and again", [](SimulatedDevice& s) { s.on_the_way_in = test::first_again(); },
       kStuck, kLate},
      {"frames come 30 ms late", [](SimulatedDevice& s) { s.on_the_way_in = test::late_by(30); }, kLate, kLate},
      {"frames come in bursts", [](SimulatedDevice& s) { s.on_the_way_in = burst(); }, kBurst, 0},
      {"frames come out of order", [](SimulatedDevice& s) { s.on_the_way_in = out_of_order(); }, 0, kOutOfOrder},
      {"a wrong checksum",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report[13] ^= 0x5A; }); },
       kCorrupt, kCorrupt},
      {"frames are cut short",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report.resize(12); }); }, kCorrupt,
       0},
      {"another version", [](SimulatedDevice& s) { s.on_the_way_in = test::changed(of_version_9); }, 0, kWrongFirmware},
      {"the board reports an error",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report[1] = 15; }); }, kOwn, 0},
      {"the device reports a motor fault", [](SimulatedDevice& s) { s.board().conditions = bridge::kMotorFault; }, 0,
       kOwn},
      {"the position jumps by 50 mm",
       [](SimulatedDevice& s) { s.counts_offset = static_cast<int>(0.05 * s.calibration.counts_per_metre); }, kJump,
       kJump},
      {"the board starts again, at position 0",
       [](SimulatedDevice& s) {
         s.model->restart();
         s.counts_offset = -s.counts();
       },
       kJump, 0},
      {"the device starts again", [](SimulatedDevice& s) { s.model->restart(); }, 0, kReset | kOutOfOrder},
      {"commands cannot be written", [](SimulatedDevice& s) { s.writer_hangs = true; }, kWriteStalled | kLate,
       kWriteStalled, 0.05},
      {"the device confirms no command", [](SimulatedDevice& s) { s.on_the_way_out = [](Report&) { return false; }; },
       0, kWriteStalled, 0.05},
      {"its clock is set back by 10 ms", [](SimulatedDevice& s) { s.board().clock_offset_us -= 10'000; }, 0, kReset},
  };
  return all;
}

// The number of ticks (ms) until the force is above 0 (`pushes`) or 0. `most` if that does not happen.
int ticks_until(SimulatedDevice& simulated, bool pushes, int most, std::uint32_t& faults) {
  for (int ticks = 1; ticks < most; ++ticks) {
    faults |= simulated.tick().device.faults;
    if ((simulated.snapshot.rendered_N > 0.0) == pushes) return ticks;
  }
  return most;
}

// Injects during a press. Returns the ticks until the force is 0.
int expect_no_force(const Injection& injection, std::uint32_t expected, SimulatedDevice& simulated) {
  injection.inject(simulated);
  std::uint32_t faults = 0;
  const int to_zero = ticks_until(simulated, false, 6000, faults);
  for (int i = 0; i < 50; ++i) faults |= simulated.tick().device.faults;
  EXPECT_NE(faults & expected, 0u);
  const bool stuck = (expected & device_fault::kStuck) != 0;
  EXPECT_LE(1e-3 * to_zero, 0.0205 + (stuck ? simulated.calibration.stuck_after_s : injection.found_after_s));
  EXPECT_NE(simulated.snapshot.faults_latched & loop_fault::kDeviceFault, 0u);
  EXPECT_NE(simulated.snapshot.device_faults_latched & expected, 0u);
  return to_zero;
}

// The disturbance has ended. A fault that loses the position lasts until the device is zeroed.
void expect_return_after_zeroing(std::uint32_t expected, SimulatedDevice& simulated) {
  simulated.run_s(1.0);
  EXPECT_EQ(simulated.snapshot.rendered_N, 0.0);
  EXPECT_NE(simulated.snapshot.device.faults & expected, 0u) << "until it is zeroed";
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::needed);
  EXPECT_EQ(simulated.snapshot.samples, 0u);
  simulated.press();
  EXPECT_EQ(simulated.snapshot.device.faults, 0u);
}

// Returns the ticks until there is a force again.
int expect_return_by_itself(SimulatedDevice& simulated) {
  // Regular delay is not detectable in reports without a time stamp.
  const bool stopped = simulated.snapshot.rendered_N == 0.0;
  std::uint32_t faults = 0;
  const int back = ticks_until(simulated, true, 1000, faults);
  EXPECT_LE(back, 300);
  EXPECT_TRUE(!stopped || simulated.snapshot.rendered_N < 0.2) << "with a ramp";
  simulated.run_s(1.2);
  EXPECT_EQ(simulated.snapshot.device.faults, 0u);
  EXPECT_NE(simulated.snapshot.device_faults_latched, 0u);
  simulated.controls.acknowledged = 1;
  simulated.run_s(0.01);
  EXPECT_EQ(simulated.snapshot.device_faults_latched, 0u);
  EXPECT_EQ(simulated.snapshot.faults_latched & loop_fault::kStops, 0u);
  return back;
}

TEST(DeviceEndpoint, EveryFaultTakesTheForceAwayUntilItEnds) {
  for (const Injection& injection : injections()) {
    if (injection.board == 0) continue;
    SCOPED_TRACE(injection.name);
    SimulatedDevice simulated(kProtocol);
    simulated.press();
    EXPECT_GT(simulated.snapshot.rendered_N, 3.5);
    const int to_zero = expect_no_force(injection, injection.board, simulated);
    std::printf("%-70s %4d ms\n", injection.name, to_zero);
    simulated.mend();
    if ((injection.board & device_fault::kLosesPosition) != 0) {
      expect_return_after_zeroing(injection.board, simulated);
    } else {
      expect_return_by_itself(simulated);
    }
    EXPECT_NEAR(simulated.motor_N(), simulated.spring_N(simulated.position_m()), kResolution_N);
  }
}

// Uses the shipped calibration. devices/README.md contains the table that this test prints.
TEST(BridgeEndpoint, EveryFaultRemovesTheForceUntilTheTimeInTheReadme) {
  const std::string source = PALPATE_SOURCE_DIR;
  const auto calibration = read_calibration(source + "/assets/devices", kBridgeProtocol);
  ASSERT_TRUE(calibration.ok());
  std::string table = "| what happens | force 0 after [ms] | comes back after its end [ms] |\n|---|---:|---:|\n";
  for (const Injection& injection : injections()) {
    if (injection.bridge == 0) continue;
    SCOPED_TRACE(injection.name);
    SimulatedDevice simulated(*calibration);
    simulated.run_s(0.2);
    simulated.rest = false;
    simulated.run_s(1.0);
    EXPECT_GT(simulated.snapshot.rendered_N, 2.0) << "near the continuous force";
    const int to_zero = expect_no_force(injection, injection.bridge, simulated);
    EXPECT_EQ(simulated.snapshot.rendered_N, 0.0);
    simulated.mend();
    simulated.counts_offset = 0;
    simulated.board().conditions = 0;
    const int back = expect_return_by_itself(simulated);
    table +=
        std::string("| ") + injection.name + " | " + std::to_string(to_zero) + " | " + std::to_string(back) + " |\n";
  }
  std::printf("%s", table.c_str());
  EXPECT_TRUE(test::has_parts(test::read_text(source + "/devices/README.md"), {table}))
      << "put the table above into devices/README.md";
}

// A bit error, a lost byte and an inserted one.
TEST(BridgeEndpoint, ADamagedFrameCostsNoForce) {
  const std::vector<void (*)(Report&)> damages = {[](Report& report) { report[13] ^= 0x10; },
                                                  [](Report& report) { report[2] ^= 0x40; },
                                                  [](Report& report) { report.erase(report.begin() + 7); },
                                                  [](Report& report) { report.insert(report.begin(), 0x50); }};
  for (std::size_t i = 0; i < damages.size(); ++i) {
    SCOPED_TRACE(i);
    SimulatedDevice simulated(&kBridgeProtocol);
    simulated.press();
    simulated.on_the_way_in = [&, n = 0](Report report) mutable {
      if (n++ % 20 == 0) damages[i](report);
      return test::Reports{report};
    };
    for (int tick = 0; tick < 500; ++tick) {
      ASSERT_GT(simulated.tick().rendered_N, 3.5) << tick;
      ASSERT_EQ(simulated.snapshot.device.faults, 0u) << tick;
    }
  }
}

TEST(BridgeEndpoint, ARateThatFallsBelowOneHundredHzTakesTheForceAwayUntilItRises) {
  for (const std::uint32_t period_us : {12'500u, 20'000u, 33'333u}) {
    SCOPED_TRACE(period_us);
    SimulatedDevice simulated(&kBridgeProtocol);
    simulated.press();
    simulated.board().period_us = period_us;
    simulated.run_s(2.0);
    EXPECT_EQ(simulated.snapshot.rendered_N, 0.0);
    EXPECT_EQ(simulated.motor_N(), 0.0);
    EXPECT_NE(simulated.snapshot.device.faults & device_fault::kSlow, 0u);
    for (int tick = 0; tick < 200; ++tick) ASSERT_EQ(simulated.tick().rendered_N, 0.0);
    simulated.board().period_us = 1000;
    std::uint32_t faults = 0;
    EXPECT_LT(ticks_until(simulated, true, 3000, faults), 1700) << "after a second";
    EXPECT_LT(simulated.snapshot.rendered_N, 0.2) << "with a ramp";
    simulated.run_s(16.0);  // eight time constants of the stability limit
    EXPECT_GT(simulated.motor_N(), 3.5);
  }
}

TEST(DeviceEndpoint, AHapticsThreadThatHangsPushesNoLonger) {
  for (const DeviceProtocol* protocol : kPushing) {
    SimulatedDevice simulated(protocol);
    simulated.press();
    EXPECT_GT(simulated.motor_N(), 3.5);
    // The writer thread continues alone.
    for (double now_s = simulated.now_s; now_s < simulated.now_s + 0.04; now_s += 0.5e-3) {
      const OutReports reports = simulated.device.next(now_s);
      for (std::size_t i = 0; i < reports.count; ++i) {
        const std::size_t skip = reports.bytes[i][0] == 0 ? 1 : 0;
        simulated.model->hear(Report(reports.bytes[i].data() + skip, reports.bytes[i].data() + reports.sizes[i]));
      }
      simulated.model->step(static_cast<std::uint32_t>(1e6 * (now_s - SimulatedDevice::kStart_s)), 0);
    }
    EXPECT_EQ(simulated.motor_N(), 0.0) << protocol->name;
  }
}

// As after SIGKILL: the host sends nothing, not even a stop command.
TEST(DeviceEndpoint, AHostThatDiesPushesNoLonger) {
  for (const DeviceProtocol* protocol : kPushing) {
    SimulatedDevice simulated(protocol);
    simulated.press();
    for (int i = 0; i < 3000; ++i) {
      simulated.tick();
      ASSERT_GT(simulated.motor_N(), 3.5) << protocol->name << ": what is renewed goes on";
    }
    std::int64_t now_us = simulated.now_us;
    const std::int64_t died_us = now_us;
    while (simulated.motor_N() > 0.0 && now_us - died_us < 1'000'000) {
      simulated.model->step(static_cast<std::uint32_t>(now_us += 250), simulated.counts());
    }
    std::printf("%-12s pushes for %.1f ms after its host died\n", protocol->name,
                1e-3 * static_cast<double>(now_us - died_us));
    EXPECT_LE(now_us - died_us, 52'000) << protocol->name;
  }
}

TEST(DeviceEndpoint, AForceLastsUntilItsNextReport) {
  const DeviceProtocol& protocol = kOpenFfBoardProtocol;
  test::OpenFfBoardModel board;
  const auto hear = [&](const OutReports& reports) {
    for (std::size_t i = 0; i < reports.count; ++i) {
      board.hear(Report(reports.bytes[i].data(), reports.bytes[i].data() + reports.sizes[i]));
    }
  };
  hear(protocol.encode_start());
  board.step(0, 0);
  EXPECT_EQ(board.force_units(), 0.0);
  const auto repeat_us = static_cast<std::uint32_t>(std::lround(1e6 * DeviceEndpoint::kRepeat_s));
  for (std::uint32_t sequence = 1; sequence < 400; ++sequence) {
    board.step(sequence * repeat_us, 0);
    if (sequence > 4) {
      ASSERT_EQ(board.force_units(), 1000.0) << sequence;
    }
    // Every fourth command contains a start of the effect; every second one of these is lost.
    if (sequence % 8 != 0) hear(protocol.encode_command({sequence, 0, true, 1000.0}));
  }
}

TEST(DeviceEndpoint, DoesNothingForbiddenInTheTick) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const DeviceProtocol* protocol : kPushing) {
    SimulatedDevice simulated(protocol);
    simulated.press();
    int offences = 0;
    for (int i = 0; i < 10000; ++i) {
      if (i == 5000) simulated.device.unplugged();
      simulated.tick();
      test::RtGuard guard;
      simulated.live.run(simulated.now_s + 1e-4, {});
      offences += guard.stop().total();
    }
    EXPECT_EQ(offences, 0) << protocol->name;
  }
}

}  // namespace
}  // namespace palpate
