// A device of the bridge against the host, in simulated time: every fault takes the force
// away, and it comes back by itself with a ramp when the fault is over.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/simulated_device.h"

namespace palpate {
namespace {

using test::Report;
using test::SimulatedDevice;

// Of a tick of tremor.
constexpr double kResolution_N = 0.1;

struct Injection {
  const char* name;
  void (*inject)(SimulatedDevice&);
  std::uint32_t fault;
  double within_s;  // force to zero
};

template <typename Change>
void on_the_way(SimulatedDevice& simulated, Change change) {
  simulated.on_the_way_in = change;
}

const std::vector<Injection>& injections() {
  using namespace device_fault;
  using Reports = std::vector<Report>;
  static const std::vector<Injection> all = {
      {"gone",
       [](SimulatedDevice& s) {
         s.unplugged = true;
         s.device.endpoint.unplugged();
       },
       kUnplugged, 0.0205},
      {"silent", [](SimulatedDevice& s) { on_the_way(s, [](const Report&) { return Reports{}; }); }, kLate, 0.0205},
      {"stuck", [](SimulatedDevice& s) { s.encoder_frozen = true; }, kStuck, 0.53},
      {"the same frame again and again",
       [](SimulatedDevice& s) {
         auto first = std::make_shared<Report>();
         on_the_way(s, [first](const Report& report) {
           if (first->empty()) *first = report;
           return Reports{*first};
         });
       },
       kLate, 0.0205},
      {"late by 30 ms",
       [](SimulatedDevice& s) {
         auto queue = std::make_shared<std::deque<Report>>();
         on_the_way(s, [queue](const Report& report) {
           queue->push_back(report);
           if (queue->size() <= 30) return Reports{};
           const Report oldest = queue->front();
           queue->pop_front();
           return Reports{oldest};
         });
       },
       kLate, 0.0205},
      {"out of order",
       [](SimulatedDevice& s) {
         auto last = std::make_shared<Report>();
         on_the_way(s, [last](const Report& report) {
           if (last->empty()) {
             *last = report;
             return Reports{};
           }
           const Report older = *last;
           last->clear();
           return Reports{report, older};
         });
       },
       kOutOfOrder, 0.0205},
      {"corrupted",
       [](SimulatedDevice& s) {
         on_the_way(s, [](Report report) {
           report[13] ^= 0x5A;
           return Reports{report};
         });
       },
       kCorrupt, 0.0205},
      {"another version",
       [](SimulatedDevice& s) {
         on_the_way(s, [](Report report) {
           report[2] = 9;
           return Reports{report};
         });
       },
       kWrongFirmware, 0.0205},
      {"motor fault",
       [](SimulatedDevice& s) { dynamic_cast<test::BridgeModel&>(*s.model).conditions = bridge::kMotorFault; }, kOwn,
       0.0205},
      {"jump", [](SimulatedDevice& s) { s.counts_offset = 50'000'000; }, kJump, 0.0205},
      {"started again", [](SimulatedDevice& s) { s.model->restart(); }, kReset | kOutOfOrder, 0.0205},
      {"commands do not get through", [](SimulatedDevice& s) { s.writer_hangs = true; }, kWriteStalled, 0.0705},
      {"hears nothing", [](SimulatedDevice& s) { s.on_the_way_out = [](Report&) { return false; }; }, kWriteStalled,
       0.0705},
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

TEST(BridgeEndpoint, EveryFaultTakesTheForceAwayAndItComesBackByItself) {
  std::printf("%-32s %9s  %s\n", "fault", "to 0 [ms]", "message");
  for (const Injection& injection : injections()) {
    SimulatedDevice simulated(&kBridgeProtocol);
    press(simulated);
    ASSERT_GT(simulated.snapshot.rendered_N, 3.5) << injection.name;
    const double from_s = simulated.now_s;
    double to_zero_s = -1.0;
    std::uint32_t faults = 0;
    injection.inject(simulated);
    for (int i = 0; i < 700; ++i) {
      simulated.tick();
      faults |= simulated.snapshot.device.faults;
      if (simulated.snapshot.rendered_N == 0.0 && to_zero_s < 0.0) to_zero_s = simulated.now_s - from_s;
    }
    const auto words = device_fault_words(faults & injection.fault);
    std::printf("%-32s %9.1f  %s\n", injection.name, 1e3 * to_zero_s, words.empty() ? "" : words.front().c_str());
    EXPECT_NE(faults & injection.fault, 0u) << injection.name;
    EXPECT_GT(to_zero_s, 0.0) << injection.name;
    EXPECT_LE(to_zero_s, injection.within_s) << injection.name;

    simulated.on_the_way_in = nullptr;
    simulated.on_the_way_out = nullptr;
    simulated.writer_hangs = simulated.encoder_frozen = false;
    simulated.counts_offset = 0;
    dynamic_cast<test::BridgeModel&>(*simulated.model).conditions = 0;
    if (simulated.unplugged) simulated.device.endpoint.connected(simulated.now_s);
    simulated.unplugged = false;
    simulated.tick();
    EXPECT_LE(simulated.snapshot.rendered_N, simulated.calibration.limits.largest_N) << injection.name;
    simulated.run_s(1.2);
    EXPECT_EQ(simulated.snapshot.device.faults, 0u) << injection.name;
    EXPECT_NEAR(simulated.motor_N(), wanted_N(simulated), kResolution_N) << injection.name;
  }
}

TEST(BridgeEndpoint, RunsFromOneHundredToTenThousandSamplesASecond) {
  for (const std::uint32_t period_us : {10'000u, 2'000u, 1'000u, 250u, 100u}) {
    SimulatedDevice simulated(&kBridgeProtocol);
    simulated.step_us = period_us < 250 ? 50 : 250;
    dynamic_cast<test::BridgeModel&>(*simulated.model).period_us = period_us;
    press(simulated);
    EXPECT_EQ(simulated.snapshot.device.faults, 0u) << period_us;
    EXPECT_NEAR(simulated.snapshot.rendered_N, wanted_N(simulated), kResolution_N) << period_us;
    EXPECT_NEAR(simulated.snapshot.device.interval_s, 1e-6 * period_us, 0.1e-6 * period_us);
    std::uint32_t samples = 0;
    for (int i = 0; i < 100; ++i) samples += simulated.tick().samples;
    EXPECT_NEAR(samples, 1e5 / period_us, 1.0) << "every one is handed over";
  }
}

// Anything from 10 kHz to 200 Hz from one sample to the next, half a second together.
TEST(BridgeEndpoint, IrregularSamplesAreAllHandedOverAndNoFault) {
  SimulatedDevice simulated(&kBridgeProtocol);
  simulated.step_us = 50;
  auto& model = dynamic_cast<test::BridgeModel&>(*simulated.model);
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
  auto& board = dynamic_cast<test::BridgeModel&>(*simulated.model);
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

TEST(BridgeEndpoint, TheDeviceStopsByItselfWithoutFramesOrHeartbeat) {
  test::BridgeModel model;
  DeviceCommand command;
  command.drive = true;
  command.units = -1e6;
  const auto send = [&] {
    const OutReports out = kBridgeProtocol.encode_command(command);
    model.hear(Report(out.bytes[0].begin(), out.bytes[0].begin() + bridge::kHostBytes));
  };
  const auto status = [&] {
    bridge::FromDevice in{};
    EXPECT_TRUE(bridge::decode(model.outbox.back().data(), in));
    return in.status;
  };
  std::uint32_t now_us = 0;
  const auto run = [&](int ms, bool frames, bool beats) {
    for (int i = 0; i < ms; ++i) {
      now_us += 1000;
      ++command.sequence;
      if (beats) ++command.heartbeat;
      if (frames) send();
      model.step(now_us, 0);
    }
  };
  run(20, true, true);
  EXPECT_EQ(model.force_units(), -1e6);
  EXPECT_EQ(status(), bridge::kDriving);
  run(49, false, false);
  EXPECT_EQ(model.force_units(), -1e6);
  run(1, false, false);
  EXPECT_EQ(model.force_units(), 0.0);
  run(1, false, false);
  EXPECT_EQ(status(), bridge::kStopped);
  run(2, true, true);
  EXPECT_EQ(model.force_units(), -1e6) << "valid frames come again";
  run(60, true, false);
  EXPECT_EQ(model.force_units(), 0.0) << "the heartbeat stood still";
  EXPECT_EQ(status(), bridge::kStopped);
  run(2, true, true);
  EXPECT_EQ(model.force_units(), -1e6);
}

}  // namespace
}  // namespace palpate
