#include "devices/link/device_link.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <poll.h>
#include <unistd.h>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <optional>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_protocol.h"
#include "devices/hid/hidapi_bus.h"
#include "engine/base/random_stream.h"
#include "engine/base/signals.h"
#include "tests/support/message_parts.h"
#include "tests/support/rt_guard.h"
#include "tests/support/simulated_device.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// Host and device in simulated time: every fault sets the force to zero, and the
// condition for its return.

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
  const Result calibration = test::must(read_calibration(source + "/assets/devices", kBridgeProtocol));
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

// Streams of readings, without transport. device_endpoint_test.cpp tests them with
// reports, force and time.

DeviceCalibration calibration_for(bool absolute_and_timed) {
  DeviceCalibration calibration;
  calibration.protocol = absolute_and_timed ? &kBridgeProtocol : &kOpenFfBoardProtocol;
  calibration.counts_per_metre = 50000.0;
  calibration.fastest_m_per_s = 5.0;
  calibration.stuck_after_s = 0.5;
  return calibration;
}

// Readings 1 ms apart, optionally of a device with absolute position and sequence numbers.
struct Stream {
  explicit Stream(bool absolute_and_timed = false) : monitor(calibration_for(absolute_and_timed)) {
    if (absolute_and_timed) steps(60);  // until its clock is identified
  }
  StreamMonitor monitor;
  DeviceReading next;
  double now_s = 10.0;

  void send(const DeviceReading& reading, double force_N = 0.0) {
    monitor.update(ReportVerdict::position, reading, now_s, force_N);
  }
  void step(std::int32_t counts = 0, double force_N = 0.0) {
    now_s += 1e-3;
    ++next.sequence;
    next.time_us += 1000;
    next.counts = counts;
    send(next, force_N);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step(next.counts);
  }
  void zero() {
    monitor.start_zeroing();
    steps(210);
    EXPECT_EQ(monitor.state().health.zeroing, Zeroing::done);
  }
};

TEST(StreamMonitor, LostReportsAreNoFault) {
  Stream stream(true);
  stream.steps(10);
  stream.next.sequence += 5;
  stream.next.time_us += 5000;
  stream.now_s += 5e-3;
  stream.step(3);
  EXPECT_EQ(stream.monitor.state().transient, 0u);
  EXPECT_EQ(stream.monitor.state().counts, 3);
}

TEST(StreamMonitor, SequenceMayWrap) {
  Stream stream(true);
  stream.next.sequence = 0x7FFFFFF0u;
  stream.steps(1);
  stream.next.sequence = 0xFFFFFFE0u;
  const std::uint64_t before = stream.monitor.state().samples;
  stream.steps(64);
  EXPECT_EQ(stream.monitor.state().samples, before + 64u);
  EXPECT_EQ(stream.monitor.state().transient, 0u);
}

TEST(StreamMonitor, TheHandMayBeFastAndTheEncoderMayNotJump) {
  Stream stream;
  stream.zero();
  std::int32_t counts = 0;
  for (int i = 1; i <= 100; ++i) stream.step(counts += std::min(250, 50 * i));  // 5 m/s after 5 ms
  EXPECT_EQ(stream.monitor.state().lost, 0u);
  stream.step(counts + 300);
  EXPECT_EQ(stream.monitor.state().lost, device_fault::kJump);
  EXPECT_EQ(stream.monitor.state().health.zeroing, Zeroing::needed);
  stream.zero();
  EXPECT_EQ(stream.monitor.state().lost, 0u);
  EXPECT_EQ(stream.monitor.state().streams, 2u);
}

// 5 mm within a millisecond from rest would need 5 m/s, that is 250 N on 50 g.
TEST(StreamMonitor, AStepFromRestThatNoHandCanMakeIsAJump) {
  for (const int mm : {1, 2, 5}) {
    Stream stream;
    stream.zero();
    stream.step(50 * mm);
    EXPECT_EQ(stream.monitor.state().lost, mm == 1 ? 0u : device_fault::kJump) << mm;
  }
}

TEST(StreamMonitor, TheCounterMayWrap) {
  StreamMonitor monitor(calibration_for(false));
  constexpr std::uint32_t kFirst = 0x7FFF'FF00u;
  double now_s = 1.0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    DeviceReading reading;
    reading.counts = static_cast<std::int32_t>(kFirst + 50 * i);
    monitor.update(ReportVerdict::position, reading, now_s += 1e-3, 0.0);
  }
  EXPECT_EQ(monitor.state().counts, std::int64_t{kFirst} + 49'950);
  EXPECT_EQ(monitor.state().lost, 0u);
}

// A hand that keeps a tool within a step of the sensor is no fault.
TEST(StreamMonitor, StandingStillIsStuckOnlyUnderForce) {
  Stream stream;
  stream.zero();
  for (int i = 0; i < 2000; ++i) stream.step(0, 0.1);
  for (int i = 0; i < 2000; ++i) stream.step(0, 0.5 + 0.1 * (i % 2));
  EXPECT_EQ(stream.monitor.state().lost, 0u) << "a small force that hardly changes";
  for (int i = 0; i < 2000; ++i) stream.step(i / 400, 3.0);
  EXPECT_EQ(stream.monitor.state().lost, 0u) << "a count now and then";
  for (int i = 0; i < 510; ++i) stream.step(4, 3.0);
  EXPECT_EQ(stream.monitor.state().lost, device_fault::kStuck);
  stream.zero();
  for (int i = 0; i < 510; ++i) stream.step(4, 0.3 + 0.3 * (i % 2));
  EXPECT_EQ(stream.monitor.state().lost, device_fault::kStuck) << "a small force that changes";
}

TEST(StreamMonitor, ASequenceThatBeginsAnewIsAReset) {
  Stream stream(true);
  stream.next = {};
  stream.steps(7);
  EXPECT_EQ(stream.monitor.state().transient, device_fault::kOutOfOrder);
  stream.steps(5);
  EXPECT_NE(stream.monitor.state().transient & device_fault::kReset, 0u);
  EXPECT_EQ(stream.monitor.state().lost, 0u) << "it knows where it is";
}

TEST(StreamMonitor, FaultsAddUpWhileTheyLast) {
  Stream stream(true);
  stream.steps(10);
  stream.monitor.update(ReportVerdict::wrong_version, {}, stream.now_s, 0.0);
  DeviceReading older = stream.next;
  older.sequence -= 3;
  stream.send(older);
  EXPECT_EQ(stream.monitor.state().transient, device_fault::kWrongFirmware | device_fault::kOutOfOrder);
  stream.now_s += 1.0;
  stream.monitor.update(ReportVerdict::wrong_version, {}, stream.now_s, 0.0);
  EXPECT_EQ(stream.monitor.state().transient, device_fault::kWrongFirmware);
}

TEST(StreamMonitor, ACorruptReportIsALostOne) {
  Stream stream(true);
  stream.steps(10);
  stream.monitor.update(ReportVerdict::corrupt, {}, stream.now_s, 0.0);
  EXPECT_EQ(stream.monitor.state().transient, 0u);
  EXPECT_EQ(stream.monitor.state().corrupt, 1u);
  stream.step();
  EXPECT_EQ(stream.monitor.state().corrupt, 0u);
}

// Ten at 1 kHz, then one every `period_us`. Returns the time in s until kSlow; negative: none within 3 s.
double slow_after_s(std::uint32_t period_us) {
  Stream stream(true);
  stream.steps(10);
  const double start_s = stream.now_s;
  while (stream.now_s < start_s + 3.0) {
    stream.now_s += 1e-6 * period_us - 1e-3;
    stream.next.time_us += period_us - 1000;
    stream.step(stream.next.counts);
    if ((stream.monitor.state().transient & device_fault::kSlow) != 0) return stream.now_s - start_s;
  }
  return -1.0;
}

TEST(StreamMonitor, FewerThanOneHundredSamplesASecondAreAFault) {
  EXPECT_LT(slow_after_s(10'000), 0.0);
  EXPECT_LT(slow_after_s(10'300), 0.0) << "the clock of a board";
  for (const std::uint32_t period_us : {11'500u, 20'000u, 50'000u}) {
    EXPECT_GT(slow_after_s(period_us), 0.0) << period_us;
    EXPECT_LT(slow_after_s(period_us), 2.5) << period_us;
  }
}

// 95.5 Hz with jitter, and 103 Hz: one cut. It ends after a second at 106 Hz.
TEST(StreamMonitor, ARateNearTheLimitIsCutOnce) {
  Stream stream(true);
  const auto slow_at = [&](double rate_Hz, double seconds) {
    int changes = 0;
    for (const double until_s = stream.now_s + seconds; stream.now_s < until_s;) {
      const bool before = (stream.monitor.state().transient & device_fault::kSlow) != 0;
      const auto period_us = static_cast<std::uint32_t>(1e6 / rate_Hz) + (stream.next.sequence % 7) * 300 - 900;
      stream.now_s += 1e-6 * period_us - 1e-3;
      stream.next.time_us += period_us - 1000;
      stream.step(stream.next.counts);
      if (((stream.monitor.state().transient & device_fault::kSlow) != 0) != before) ++changes;
    }
    return changes;
  };
  EXPECT_EQ(slow_at(200.0, 0.5), 0);
  EXPECT_EQ(slow_at(95.5, 20.0), 1);
  EXPECT_EQ(slow_at(103.0, 5.0), 0) << "not yet";
  EXPECT_EQ(slow_at(107.0, 1.0), 0) << "not yet";
  EXPECT_EQ(slow_at(107.0, 3.0), 0) << "the fault is no longer renewed";
  EXPECT_GT(stream.now_s, stream.monitor.state().transient_until_s);
}

TEST(StreamMonitor, LostSamplesOfADeviceWithOneHundredASecondAreNoFault) {
  Stream stream(true);
  for (int i = 1; i < 300; ++i) {
    const std::uint32_t period_us = i % 50 == 0 ? 20'000 : 10'000;  // 2 % are lost
    stream.now_s += 1e-6 * period_us - 1e-3;
    stream.next.time_us += period_us - 1000;
    stream.step(stream.next.counts);
    ASSERT_EQ(stream.monitor.state().transient, 0u) << i;
  }
}

TEST(StreamMonitor, ZeroingTakesTheMiddleOfWhereItRested) {
  Stream stream;
  stream.monitor.start_zeroing();
  for (int i = 0; i < 210; ++i) stream.step(100 + i % 2 * 10);
  EXPECT_EQ(stream.monitor.state().health.zeroing, Zeroing::done);
  EXPECT_EQ(stream.monitor.state().zero_counts, 105.0);
}

// Valid and broken calibration files.

const std::string kAssets = std::string(PALPATE_SOURCE_DIR) + "/assets/devices";

std::string good() { return test::read_text(kAssets + "/openffboard.json"); }

// The message about the text without its folder.
std::string complaint(const std::string& text) {
  const test::TemporaryFolder folder;
  folder.with_file("openffboard.json", text);
  const Result<DeviceCalibration> result = read_calibration(folder.path(), kOpenFfBoardProtocol);
  return result ? "accepted" : result.error().message.substr(folder.path().size() + 1);
}

TEST(DeviceCalibration, ReadsEveryKindOfTheAssets) {
  for (const DeviceProtocol* protocol : kHidProtocols) {
    const Result<DeviceCalibration> calibration = read_calibration(kAssets, *protocol);
    ASSERT_TRUE(calibration.ok()) << calibration.error().message;
    EXPECT_EQ(calibration->protocol, protocol);
    EXPECT_GT(calibration->counts_per_metre, 0.0);
  }
  const Result<DeviceCalibration> board = read_calibration(kAssets, kOpenFfBoardProtocol);
  EXPECT_EQ(board->limits.largest_N, 5.0);
  EXPECT_EQ(board->limits.continuous_N, 2.0);
  EXPECT_EQ(board->limits.stale_after_s, 0.01);
}

TEST(DeviceCalibration, ErrorsHaveThePlace) {
  EXPECT_EQ(complaint("{").rfind("openffboard.json:1:2: syntax error", 0), 0u) << complaint("{");
  EXPECT_TRUE(test::has_parts(complaint("[]"), {"openffboard.json:1:1:", "list of 0", "\"kind\""}));
  test::expect_messages(
      good(), complaint,
      {{R"("direction": 1)", R"("direction": 0.5)", {"openffboard.json:4:16:", "direction", "0.5", "1 or -1"}},
       {R"("peak_N": 5)", R"("peak_N": 500)", {"openffboard.json:9:13:", "peak_N", "500", "0.001", "100"}},
       {R"("peak_N": 5)", R"("peak_N": 1)", {"openffboard.json:10:19:", "continuous_N", "found 2,", "peak_N"}},
       {"  \"ramp_s\": 0.5,\n", "", {"openffboard.json:1:1:", "ramp_s", "0.05", "10"}},
       {R"("ramp_s": 0.5)", R"("ramp_s": "slow")", {"openffboard.json:13:13:", "ramp_s", "\"slow\"", "0.05", "10"}},
       {R"("openffboard")", R"("joystick")", {"openffboard.json:2:11:", "kind", "\"joystick\"", "openffboard"}},
       {R"("ramp_s": 0.5)", R"("ramp_s": 0.5, "colour": 3)", {"openffboard.json:13:28:", "colour", "kind"}}});
}

// Conversion of the device's time to the host's clock.

// Reports every 1 ms with up to 0.4 ms of jitter, from a device whose clock is 100 ppm
// fast and wraps: the time steps between samples are still even.
TEST(DeviceClock, TakesTheJitterAway) {
  DeviceClock clock;
  RandomStream random(1, 0);
  double last_s = 0.0;
  double worst_step_s = 0.0, worst_lag_s = 0.0;
  for (int i = 0; i < 60'000; ++i) {
    const double true_s = 10.0 + 1e-3 * i;
    const auto device_us = static_cast<std::uint32_t>(4'290'000'000u + static_cast<std::uint32_t>(1000.1 * i));
    const double host_s = clock.host_time_s(device_us, true_s + 0.2e-3 + random.uniform(0.0, 0.4e-3));
    if (i > 1000) {
      worst_step_s = std::max(worst_step_s, std::abs(host_s - last_s - 1e-3));
      worst_lag_s = std::max(worst_lag_s, std::abs(host_s - true_s));
    }
    last_s = host_s;
  }
  EXPECT_LT(worst_step_s, 30e-6);
  EXPECT_LT(worst_lag_s, 1.3e-3) << "the shortest way, and the drift it follows";
}

// The stop command that is sent when a signal ends the program.

// Writes reports without pause, each blocked for 2 ms as by a slow device.
void push_without_end(int descriptor) {
  DeviceCommand command;
  command.drive = true;
  command.units = 500;
  const OutReports push = kBridgeProtocol.encode_command(command);
  while (true) {
    if (!begin_force_write()) continue;
    poll(nullptr, 0, 2);
    [[maybe_unused]] const auto written = write(descriptor, push.bytes[0].data(), push.sizes[0]);
    end_force_write();
  }
}

// Runs `end` in a child process with a device. With `renders` it renders force all the time and listens for a first
// signal. Checks that `signal` ends the child and that the last command to the device is the stop.
template <typename End>
void expect_stop_before(int signal, bool renders, End end) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    // Default handlers, because nohup starts a program with ignored signals, and sanitizers handle crashes.
    for (const int one : {SIGINT, SIGTERM, SIGHUP, SIGSEGV}) ::signal(one, SIG_DFL);
    std::optional<StopListener> listener;
    if (renders) listener.emplace();
    register_device_stop(ends[1], kBridgeProtocol.encode_stop());
    if (renders) std::thread([&] { push_without_end(ends[1]); }).detach();
    end();
    _exit(7);
  }
  close(ends[1]);
  std::uint8_t bytes[bridge::kHostBytes];
  bridge::FromHost out{};
  int reports = 0;
  for (; read(ends[0], bytes, sizeof bytes) == sizeof bytes; ++reports) ASSERT_TRUE(bridge::decode(bytes, out));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_GT(reports, renders ? 2 : 0);
  EXPECT_TRUE(out.flags == 0 && out.force_uN == 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
}

TEST(DeviceStop, StopsDevicesBeforeASignalOrACrashEndsTheProgram) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGABRT}) {
    SCOPED_TRACE(signal);
    expect_stop_before(signal, false,
                       [signal] { signal == SIGABRT ? std::abort() : static_cast<void>(raise(signal)); });
  }
}

TEST(DeviceStop, NoForceFollowsTheStopInAnyOrderOfTwoSignals) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
      SCOPED_TRACE(std::to_string(first) + " then " + std::to_string(second));
      expect_stop_before(second, true, [first, second] {
        poll(nullptr, 0, 10);
        raise(first);
        poll(nullptr, 0, 10);
        raise(second);
      });
    }
  }
}

TEST(DeviceStop, HoldsEightDevices) {
  int slots[9];
  for (int& slot : slots) slot = register_device_stop(0, {});
  EXPECT_EQ(slots[8], -1);
  for (const int slot : slots) unregister_device_stop(slot);
  const int again = register_device_stop(0, {});
  EXPECT_GE(again, 0);
  unregister_device_stop(again);
}

}  // namespace
}  // namespace palpate
