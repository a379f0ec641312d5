// Host and device in simulated time: every fault sets the force to zero, and the
// condition for its return.
#include "devices/link/device_endpoint.h"
#include "devices/hid/hid_protocols.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/rt_guard.h"
#include "tests/support/simulated_device.h"

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
  EXPECT_TRUE(std::isnan(simulated.snapshot.device.round_trip_s)) << "it confirms nothing";
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

// A disturbance of the stream, and the fault that detects it.
struct Injection {
  const char* name;
  void (*inject)(SimulatedDevice&);
  std::uint32_t fault;
  double found_after_s;  // the earliest time of detection
};

const std::vector<Injection>& injections() {
  using namespace device_fault;
  static const std::vector<Injection> all = {
      {"unplugged", [](SimulatedDevice& s) { s.unplug(); }, kUnplugged, 0.0},
      {"silent", [](SimulatedDevice& s) { s.on_the_way_in = test::lost; }, kLate, 0.0},
      {"stuck at one value", [](SimulatedDevice& s) { s.encoder_frozen = true; }, kStuck, 0.5},
      {"the same report again and again", [](SimulatedDevice& s) { s.on_the_way_in = test::first_again(); }, kStuck,
       0.5},
      {"late by 20 ms", [](SimulatedDevice& s) { s.on_the_way_in = test::late_by(20); }, kLate, 0.0},
      {"corrupted",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report[13] ^= 0x5A; }); },
       kCorrupt, 0.0},
      {"cut short",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report.resize(12); }); }, kCorrupt,
       0.0},
      {"a burst of old ones",
       [](SimulatedDevice& s) {
         s.on_the_way_in = [held = test::Reports()](const Report& report) mutable {
           held.push_back(report);
           return held.size() < 30 ? test::Reports() : std::exchange(held, {});
         };
       },
       kBurst, 0.0},
      {"encoder jump", [](SimulatedDevice& s) { s.counts_offset = 5000; }, kJump, 0.0},
      {"firmware reset",
       [](SimulatedDevice& s) {
         s.model->restart();
         s.counts_offset = -s.counts();
       },
       kJump, 0.0},
      {"an error of its own",
       [](SimulatedDevice& s) { s.on_the_way_in = test::changed([](Report& report) { report[1] = 15; }); }, kOwn, 0.0},
      {"commands do not get through", [](SimulatedDevice& s) { s.writer_hangs = true; }, kWriteStalled | kLate, 0.05},
  };
  return all;
}

struct Outcome {
  double to_zero_s = -1.0;  // until the host commands zero force
  std::uint32_t faults = 0;
  std::uint32_t first_faults = 0;
};

Outcome run(const Injection& injection, SimulatedDevice& simulated) {
  Outcome outcome;
  simulated.press();
  EXPECT_GT(simulated.snapshot.rendered_N, 3.5);
  const double from_s = simulated.now_s;
  injection.inject(simulated);
  for (int i = 0; i < 800; ++i) {
    simulated.tick();
    outcome.faults |= simulated.snapshot.device.faults;
    if (outcome.first_faults == 0) outcome.first_faults = outcome.faults;
    if (simulated.snapshot.rendered_N == 0.0 && outcome.to_zero_s < 0.0) outcome.to_zero_s = simulated.now_s - from_s;
  }
  return outcome;
}

// The disturbance has ended. A fault that loses the position lasts until the device is zeroed.
void expect_return_after_zeroing(const Injection& injection, SimulatedDevice& simulated) {
  simulated.run_s(1.0);
  EXPECT_EQ(simulated.snapshot.rendered_N, 0.0);
  EXPECT_NE(simulated.snapshot.device.faults & injection.fault, 0u) << "until it is zeroed";
  EXPECT_EQ(simulated.snapshot.device.zeroing, Zeroing::needed);
  EXPECT_EQ(simulated.snapshot.samples, 0u);
  simulated.press();
  EXPECT_EQ(simulated.snapshot.device.faults, 0u);
}

void expect_return_by_itself(SimulatedDevice& simulated) {
  // Regular delay is not detectable in reports without a time stamp.
  const bool stopped = simulated.snapshot.rendered_N == 0.0;
  simulated.tick();
  EXPECT_TRUE(!stopped || simulated.snapshot.rendered_N < 0.2) << "not at once";
  simulated.run_s(1.0);
  EXPECT_NE(simulated.snapshot.device_faults_latched, 0u);
  simulated.controls.acknowledged = 1;
  simulated.run_s(0.01);
  EXPECT_EQ(simulated.snapshot.device_faults_latched, 0u);
  EXPECT_EQ(simulated.snapshot.faults_latched & loop_fault::kStops, 0u);
}

TEST(DeviceEndpoint, EveryFaultTakesTheForceAwayUntilItEnds) {
  std::printf("%-32s %9s  %s\n", "fault", "to 0 [ms]", "message");
  for (const Injection& injection : injections()) {
    SCOPED_TRACE(injection.name);
    SimulatedDevice simulated(kProtocol);
    const Outcome outcome = run(injection, simulated);
    const auto words = device_fault_words(outcome.first_faults);
    std::printf("%-32s %9.1f  %s\n", injection.name, 1e3 * outcome.to_zero_s,
                words.empty() ? "" : words.front().c_str());
    EXPECT_NE(outcome.faults & injection.fault, 0u);
    EXPECT_GT(outcome.to_zero_s, 0.0);
    EXPECT_LE(outcome.to_zero_s, 0.0205 + injection.found_after_s);
    EXPECT_NE(simulated.snapshot.faults_latched & loop_fault::kDeviceFault, 0u);
    EXPECT_NE(simulated.snapshot.device_faults_latched & injection.fault, 0u);

    simulated.mend();
    if ((injection.fault & device_fault::kLosesPosition) != 0) {
      expect_return_after_zeroing(injection, simulated);
    } else {
      expect_return_by_itself(simulated);
    }
    EXPECT_NEAR(simulated.motor_N(), simulated.spring_N(simulated.position_m()), kResolution_N);
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
