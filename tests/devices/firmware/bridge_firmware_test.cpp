// The reference firmware of a bridge device, on a simulated board.
#include "devices/firmware/bridge_firmware.h"

#include <gtest/gtest.h>

#include "tests/support/simulated_device.h"

namespace palpate::bridge {
namespace {

struct Device {
  test::BridgeModel board;
  uint32_t now_us = 4'294'900'000u;  // wraps within the test
  uint32_t sequence = 0;
  uint16_t heartbeat = 0;
  FromDevice last{};

  Device() { board.conditions = kGrip; }
  int32_t force_uN() const { return static_cast<int32_t>(-board.force_units()); }
  void run_us(uint32_t span_us) {
    for (uint32_t i = 0; i < span_us; i += 100) board.step(now_us += 100, -7);
    if (board.outbox.empty()) return;
    EXPECT_TRUE(decode(board.outbox.back().data(), last));
  }
  void hear(const FromHost& out, uint8_t damage = 0) {
    test::Report frame(kHostBytes);
    encode(out, frame.data());
    frame.back() ^= damage;
    board.hear(frame);
  }
  void push(int32_t force) {
    hear({++sequence, force, ++heartbeat, kDrive});
    run_us(1000);
  }
};

TEST(BridgeFirmware, SendsEverySampleAndDrivesAsAsked) {
  Device device;
  EXPECT_EQ(device.force_uN(), 0) << "off from the first instruction";
  for (int i = 0; i < 100; ++i) device.push(300);
  EXPECT_EQ(device.force_uN(), 300);
  EXPECT_NEAR(static_cast<double>(device.board.outbox.size()), 100.0, 1.0);
  EXPECT_EQ(device.last.status, kDriving | kGrip);
  EXPECT_EQ(device.last.position_nm, -7);
  EXPECT_EQ(device.last.force_uN, 250'000);
  EXPECT_NEAR(device.last.confirmed, device.sequence, 1);
  EXPECT_NEAR(device.last.time_us, device.now_us, 1000.0) << "across the wrap of the clock";
  EXPECT_LT(device.now_us, 1'000'000u);
}

TEST(BridgeFirmware, StopsByItselfWithin50Milliseconds) {
  Device device;
  device.push(300);
  device.run_us(48'000);
  EXPECT_EQ(device.force_uN(), 300);
  device.run_us(2000);
  EXPECT_EQ(device.force_uN(), 0);
  device.run_us(1000);
  EXPECT_EQ(device.last.status, kStopped | kGrip);
  device.push(300);
  EXPECT_EQ(device.force_uN(), 300) << "valid frames come again";
}

TEST(BridgeFirmware, StopsWhenOnlyTheThreadThatWritesLives) {
  Device device;
  device.push(300);
  for (int i = 0; i < 51; ++i) {
    device.hear({++device.sequence, 300, device.heartbeat, kDrive});
    device.run_us(1000);
  }
  EXPECT_EQ(device.force_uN(), 0);
  device.push(300);
  EXPECT_EQ(device.force_uN(), 300) << "the heartbeat goes on";
}

TEST(BridgeFirmware, ObeysOnlyNewFramesUnlessTheyStop) {
  Device device;
  device.push(300);
  device.hear({device.sequence, 900, 77, kDrive});
  device.hear({device.sequence - 1, 900, 78, kDrive});
  device.hear({device.sequence + 1, 900, 79, kDrive}, 1);
  device.run_us(2000);
  EXPECT_EQ(device.force_uN(), 300);
  device.hear({0, 0, 0, 0});
  device.run_us(100);
  EXPECT_EQ(device.force_uN(), 0);
}

TEST(BridgeFirmware, ClampsAndStopsOnAFaultOfItsOwn) {
  Device device;
  device.push(32'000'000);
  EXPECT_EQ(device.force_uN(), 5'000'000);
  device.push(-32'000'000);
  EXPECT_EQ(device.force_uN(), -5'000'000);
  for (const uint8_t fault : {kMotorFault, kSensorFault}) {
    device.board.conditions = fault;
    device.run_us(100);
    EXPECT_EQ(device.force_uN(), 0) << "at once";
    device.push(-500);
    EXPECT_EQ(device.force_uN(), 0);
    EXPECT_EQ(device.last.status, fault);
    device.board.conditions = 0;
    device.push(-500);
    EXPECT_EQ(device.force_uN(), -500);
  }
}

}  // namespace
}  // namespace palpate::bridge
