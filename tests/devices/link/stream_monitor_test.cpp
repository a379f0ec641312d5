// Streams of readings, without transport. device_endpoint_test.cpp tests them with
// reports, force and time.
#include "devices/link/device_endpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "devices/bridge/bridge_bus.h"
#include "devices/hid/hidapi_bus.h"

namespace palpate {
namespace {

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

}  // namespace
}  // namespace palpate
