#include "devices/bridge/bridge_bus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "engine/base/random_stream.h"
#include "tests/support/simulated_device.h"

namespace palpate {
namespace {

// The frames of the bridge, byte for byte, and the finder of frames in a stream.

using Bytes = std::vector<std::uint8_t>;
using Finder = bridge::FrameFinder<bridge::kDeviceBytes, bridge::kFromDevice>;

Bytes from_hex(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// Made with Python's struct and zlib from the table of devices/README.md.
const Bytes kFromDevice = from_hex("5042014904030201feffffff60dad9ff87d612001100efbe22e2ae74");
const Bytes kFromHost = from_hex("5042014f0100feca4039d2ff34120100cbe4a001");

// What is found in `bytes` that is not skipped.
bridge::Found found_in(const Bytes& bytes) {
  Finder finder;
  for (const std::uint8_t byte : bytes) {
    const bridge::Found found = finder.add(byte);
    if (found == bridge::Found::frame || found == bridge::Found::other_version) return found;
  }
  return bridge::Found::nothing;
}

// The verdict of a connection about `bytes`; corrupt if there is no frame.
ReportVerdict verdict_of(const Bytes& bytes, DeviceReading* reading = nullptr) {
  DeviceReading none;
  BridgeReports reports;
  std::uint8_t report[bridge::kDeviceBytes];
  const std::uint8_t* at = bytes.data();
  const int size = reports.next(at, bytes.data() + bytes.size(), report);
  return kBridgeProtocol.decode(report, static_cast<std::size_t>(size), reading != nullptr ? *reading : none);
}

TEST(BridgeProtocol, IsThatOfThePageByteForByte) {
  Bytes frame(bridge::kDeviceBytes);
  bridge::encode(bridge::FromDevice{0x01020304, 0xFFFFFFFE, -2'500'000, 1'234'567, 17, 0xBEEF}, frame.data());
  EXPECT_EQ(frame, kFromDevice);
  Bytes command(bridge::kHostBytes);
  bridge::encode(bridge::FromHost{0xCAFE0001, -3'000'000, 0x1234, bridge::kDrive}, command.data());
  EXPECT_EQ(command, kFromHost);
}

TEST(BridgeProtocol, ReadsTheFramesOfTheDevice) {
  DeviceReading reading;
  ASSERT_EQ(verdict_of(kFromDevice, &reading), ReportVerdict::position);
  EXPECT_EQ(reading.sequence, 0x01020304u);
  EXPECT_EQ(reading.time_us, 0xFFFFFFFEu);
  EXPECT_EQ(reading.counts, -2'500'000);
  EXPECT_EQ(reading.measured_N, 1.234567);
  EXPECT_EQ(reading.confirmed, 0xBEEFu);
  EXPECT_TRUE(reading.grip);
  EXPECT_TRUE(reading.driving);
  EXPECT_FALSE(reading.stopped);
  EXPECT_FALSE(reading.own_fault);
}

TEST(BridgeProtocol, ReadsNoForceFromADeviceWithoutASensor) {
  Bytes frame(bridge::kDeviceBytes);
  bridge::encode(bridge::FromDevice{1, 1, 0, bridge::kNoForce, 0, 0}, frame.data());
  EXPECT_EQ(wire::read32(frame.data() + 16), 0x80000000u);
  DeviceReading reading;
  ASSERT_EQ(verdict_of(frame, &reading), ReportVerdict::position);
  EXPECT_TRUE(std::isnan(reading.measured_N));
}

TEST(BridgeProtocol, PushesOutwardForAPositiveForce) {
  DeviceCommand command;
  command.sequence = 7;
  command.drive = true;
  command.units = -2e6;  // uN towards growing positions
  const OutReports reports = kBridgeProtocol.encode_command(command);
  ASSERT_EQ(reports.sizes[0], bridge::kHostBytes);
  bridge::FromHost out{};
  ASSERT_TRUE(bridge::decode(reports.bytes[0].data(), out));
  EXPECT_EQ(out.force_uN, 2'000'000);
  EXPECT_EQ(out.flags, bridge::kDrive);
  const OutReports stop = kBridgeProtocol.encode_stop();
  ASSERT_TRUE(bridge::decode(stop.bytes[0].data(), out));
  EXPECT_EQ(out.force_uN, 0);
  EXPECT_EQ(out.flags, 0);
}

TEST(BridgeProtocol, RefusesEveryFrameWithOneBitWrong) {
  for (std::size_t bit = 0; bit < 8 * kFromDevice.size(); ++bit) {
    Bytes frame = kFromDevice;
    frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_EQ(found_in(frame), bridge::Found::nothing) << "bit " << bit;
    EXPECT_NE(verdict_of(frame), ReportVerdict::position) << "bit " << bit;
  }
}

TEST(BridgeProtocol, RefusesInvalidFrames) {
  Bytes frame(bridge::kDeviceBytes);
  for (const bridge::FromDevice& in : {bridge::FromDevice{1, 1, INT32_MIN, 0, 0, 0},      // the integer of a NaN
                                       bridge::FromDevice{1, 1, 1'000'000'001, 0, 0, 0},  // beyond a metre
                                       bridge::FromDevice{1, 1, 0, 0, 32, 0}}) {          // an unknown bit
    bridge::encode(in, frame.data());
    EXPECT_EQ(verdict_of(frame), ReportVerdict::corrupt);
  }
  EXPECT_EQ(verdict_of(Bytes(27, 0)), ReportVerdict::corrupt);
  EXPECT_EQ(verdict_of({}), ReportVerdict::corrupt);
}

TEST(FrameFinder, ReportsAnotherVersion) {
  Bytes other = kFromDevice;
  other[2] = 2;
  wire::write32(other.data() + 24, wire::crc32(other.data(), 24));
  EXPECT_EQ(found_in(other), bridge::Found::other_version);
  DeviceReading reading;
  EXPECT_EQ(verdict_of(other, &reading), ReportVerdict::wrong_version);
  EXPECT_EQ(reading.version, 2);
}

// A bridge device and the host, in simulated time: every rate of samples, and the grip. Its faults are in
// device_endpoint_test.cpp.

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

// A bridge device whose clock differs from the host's, in simulated time, for several sample rates, drifts and events.

struct Event {
  const char* name;
  void (*begin)(SimulatedDevice&);
  double lasts_s;
  bool ends;  // the line is as before afterwards
  // Of the mean force before, that is left afterwards. With more lag it is smaller on purpose.
  double least_share = 0.98, most_share = 1.02;
};

void later_by_15_ms(SimulatedDevice& simulated) {
  auto queue = std::make_shared<std::deque<std::pair<double, Report>>>();
  simulated.on_the_way_in = [queue, &simulated](const Report& report) {
    queue->emplace_back(simulated.now_s + 0.015, report);
    std::vector<Report> due;
    for (; !queue->empty() && queue->front().first <= simulated.now_s; queue->pop_front()) {
      due.push_back(queue->front().second);
    }
    return due;
  };
}

void silence(SimulatedDevice& simulated) { simulated.on_the_way_in = test::lost; }

constexpr Event kEvents[] = {
    {"nothing", [](SimulatedDevice&) {}, 0.0, false},
    {"15 ms later from now on", later_by_15_ms, 0.0, false, 0.12, 0.5},
    {"clock set back by 10 ms", [](SimulatedDevice& s) { s.board().clock_offset_us -= 10'000; }, 0.0, false},
    {"clock set forward by 10 ms", [](SimulatedDevice& s) { s.board().clock_offset_us += 10'000; }, 0.0, false,
     0.4},  // it looks like a force that is older
    {"silent for 1 s", silence, 1.0, true},
    {"silent for 10 s", silence, 10.0, true},
};

// During the event, and for this time after it, the force may be zero: 100 ms until the old stream is abandoned, 50 ms
// until the new clock is identified, and 100 ms that a fault lasts.
constexpr double kRecovery_s = 0.3;
constexpr double kWatched_s = 2.5;

TEST(BridgeClock, NeitherDriftNorDelayCostsTheForceForLong) {
  for (const std::uint32_t period_us : {10'000u, 3'333u, 1'000u, 100u}) {
    for (const double drift : {-0.01, -150e-6, 0.0, 0.01}) {
      for (const Event& event : kEvents) {
        SimulatedDevice simulated(&kBridgeProtocol);
        simulated.step_us = period_us < 250 ? 100 : 250;
        simulated.board().period_us = period_us;
        simulated.board().clock_drift = drift;
        simulated.rest = false;
        simulated.run_s(1.0);
        double mean_N = 0.0;
        const auto without_ms = [&](double seconds) {
          const int count = static_cast<int>(1e3 * seconds);
          int ticks = 0;
          mean_N = 0.0;
          for (int i = 0; i < count; ++i) {
            ticks += simulated.tick().rendered_N == 0.0 ? 1 : 0;
            mean_N += simulated.snapshot.rendered_N / count;
          }
          return ticks;
        };
        const int before = without_ms(1.0);
        const double before_N = mean_N;
        event.begin(simulated);
        simulated.run_s(event.lasts_s);
        if (event.ends) simulated.on_the_way_in = nullptr;
        simulated.run_s(kRecovery_s);
        const int after = without_ms(kWatched_s);
        SCOPED_TRACE(std::to_string(1'000'000 / period_us) + " Hz, " + std::to_string(1e6 * drift) + " ppm, " +
                     event.name);
        EXPECT_EQ(before, 0) << "ms without force after 1 s";
        EXPECT_EQ(after, 0) << "ms without force after recovery";
        EXPECT_EQ(simulated.snapshot.device.faults, 0u);
        EXPECT_GE(mean_N, event.least_share * before_N);
        EXPECT_LE(mean_N, event.most_share * before_N);
        EXPECT_NEAR(simulated.motor_N(), simulated.spring_N(simulated.position_m()), 0.15);
      }
    }
  }
}

// The reference firmware and the host in ten minutes of simulated time.

// Reports are lost and corrupted in both directions and reordered from the device; both
// lines stall and the device restarts. The motor must never get a force outside the range
// of the model, a force step, or a force computed from old data.
TEST(BridgeFirmwareAndHost, TenMinutesOfTroubleAndNoUnsafeForce) {
  SimulatedDevice simulated(&kBridgeProtocol);
  RandomStream random(1, 0);
  int restarts = 0;
  int silent_in = 0, silent_out = 0;
  Report waiting;
  const auto trouble = [&](double share) { return random.uniform(0.0, 1.0) < share; };
  simulated.on_the_way_in = [&](const Report& report) {
    if (silent_in > 0) --silent_in;
    if (silent_in > 0 || trouble(0.02)) return std::vector<Report>{};
    std::vector<Report> some = {report};
    if (trouble(0.0003)) {
      some[0][random.index(some[0].size())] ^= static_cast<std::uint8_t>(1 + random.index(255));
    }
    if (!waiting.empty()) some.push_back(std::exchange(waiting, {}));
    if (trouble(0.0003)) {
      waiting = std::exchange(some[0], some.back());
      some.pop_back();
    }
    return some;
  };
  simulated.on_the_way_out = [&](Report& report) {
    if (silent_out > 0) --silent_out;
    if (silent_out > 0 || trouble(0.02)) return false;
    if (trouble(0.001)) report[random.index(report.size())] ^= static_cast<std::uint8_t>(1 + random.index(255));
    return true;
  };
  simulated.press();
  double last_N = simulated.snapshot.rendered_N, pushed_s = 0.0, age_of_push_s = 0.0;
  for (int tick = 0; tick < 600'000; ++tick) {
    if (trouble(0.0001)) silent_in = static_cast<int>(random.index(100));
    if (trouble(0.0001)) silent_out = static_cast<int>(random.index(100));
    if (trouble(0.00001)) simulated.model->restart(), ++restarts;
    const LoopSnapshot& snapshot = simulated.tick();
    const double motor_N = simulated.motor_N();
    ASSERT_TRUE(std::isfinite(motor_N));
    ASSERT_LE(motor_N, SimulatedDevice::kStiffness_N_per_m * 6.3e-3) << tick;
    ASSERT_LE(std::abs(snapshot.rendered_N - last_N), 0.45) << tick;
    last_N = snapshot.rendered_N;
    if (snapshot.device.sample_age_s <= 0.008) age_of_push_s = simulated.now_s;
    // The host sets the force to zero within 20 ms; a device without host within 50 ms more.
    ASSERT_TRUE(snapshot.rendered_N == 0.0 || simulated.now_s - age_of_push_s <= 0.0205) << tick;
    ASSERT_TRUE(motor_N == 0.0 || simulated.now_s - age_of_push_s <= 0.0755) << tick;
    if (motor_N > 0.5) pushed_s += 1e-3;
  }
  EXPECT_GT(restarts, 0);
  EXPECT_GT(pushed_s, 60.0) << "or nothing was shown";
}

}  // namespace
}  // namespace palpate
