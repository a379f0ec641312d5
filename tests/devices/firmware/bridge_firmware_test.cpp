// The reference firmware of a bridge device, on a simulated board.
#include "devices/firmware/bridge_firmware.h"

#include <gtest/gtest.h>

#include <array>
#include <deque>

namespace palpate::bridge {
namespace {

using Frame = std::array<uint8_t, kHostBytes>;

class SimulatedBoard {
 public:
  uint32_t now_us() { return time_us; }
  bool receive(uint8_t& byte) {
    if (inbox.empty()) return false;
    byte = inbox.front();
    inbox.pop_front();
    return true;
  }
  bool sample(uint32_t& at_us, int32_t& position_nm, int32_t& measured_uN) {
    if (time_us - sampled_us < 1000) return false;
    at_us = sampled_us = time_us;
    position_nm = -7;
    measured_uN = kNoForce;
    return true;
  }
  uint8_t condition() { return conditions; }
  void push(int32_t value) { force_uN = value; }
  void send(const uint8_t* frame) {
    ++sent;
    EXPECT_TRUE(decode(frame, last));
  }

  uint32_t time_us = 4'294'000'000u;  // wraps within the test
  uint32_t sampled_us = time_us;
  uint8_t conditions = kGrip;
  int32_t force_uN = 99;
  int sent = 0;
  std::deque<uint8_t> inbox;
  FromDevice last{};
};

struct Device {
  SimulatedBoard board;
  Firmware<SimulatedBoard> firmware{board, 1000};
  uint32_t sequence = 0;
  uint16_t heartbeat = 0;

  void run_us(uint32_t span_us) {
    for (uint32_t i = 0; i < span_us; i += 100) {
      board.time_us += 100;
      firmware.loop();
    }
  }
  void hear(const FromHost& out) {
    Frame frame{};
    encode(out, frame.data());
    board.inbox.insert(board.inbox.end(), frame.begin(), frame.end());
  }
  void push(int32_t force_uN) {
    hear({++sequence, force_uN, ++heartbeat, kDrive});
    run_us(1000);
  }
};

TEST(BridgeFirmware, SendsEverySampleAndDrivesAsAsked) {
  Device device;
  EXPECT_EQ(device.board.force_uN, 0) << "off from the first instruction";
  for (int i = 0; i < 100; ++i) device.push(300);
  EXPECT_EQ(device.board.force_uN, 300);
  EXPECT_NEAR(device.board.sent, 100, 1);
  EXPECT_EQ(device.board.last.status, kDriving | kGrip);
  EXPECT_EQ(device.board.last.position_nm, -7);
  EXPECT_EQ(device.board.last.force_uN, kNoForce);
  EXPECT_NEAR(device.board.last.confirmed, device.sequence, 1);
  EXPECT_EQ(device.board.last.time_us, device.board.sampled_us) << "across the wrap of the clock";
}

TEST(BridgeFirmware, StopsByItselfWithin50Milliseconds) {
  Device device;
  device.push(300);
  device.run_us(48'000);
  EXPECT_EQ(device.board.force_uN, 300);
  device.run_us(2000);
  EXPECT_EQ(device.board.force_uN, 0);
  device.run_us(1000);
  EXPECT_EQ(device.board.last.status, kStopped | kGrip);
  device.push(300);
  EXPECT_EQ(device.board.force_uN, 300) << "valid frames come again";
}

TEST(BridgeFirmware, StopsWhenOnlyTheThreadThatWritesLives) {
  Device device;
  device.push(300);
  for (int i = 0; i < 51; ++i) {
    device.hear({++device.sequence, 300, device.heartbeat, kDrive});
    device.run_us(1000);
  }
  EXPECT_EQ(device.board.force_uN, 0);
  device.push(300);
  EXPECT_EQ(device.board.force_uN, 300) << "the heartbeat goes on";
}

TEST(BridgeFirmware, ObeysOnlyNewFramesUnlessTheyStop) {
  Device device;
  device.push(300);
  device.hear({device.sequence, 900, 77, kDrive});
  device.hear({device.sequence - 1, 900, 78, kDrive});
  device.hear({device.sequence + 1, 900, 79, kDrive});
  device.board.inbox.back() ^= 1;
  device.run_us(2000);
  EXPECT_EQ(device.board.force_uN, 300);
  device.hear({0, 0, 0, 0});
  device.run_us(100);
  EXPECT_EQ(device.board.force_uN, 0);
}

TEST(BridgeFirmware, ClampsAndStopsOnAFaultOfItsOwn) {
  Device device;
  device.push(32000);
  EXPECT_EQ(device.board.force_uN, 1000);
  device.push(-32768);
  EXPECT_EQ(device.board.force_uN, -1000);
  for (const uint8_t fault : {kMotorFault, kSensorFault}) {
    device.board.conditions = fault;
    device.run_us(100);
    EXPECT_EQ(device.board.force_uN, 0) << "at once";
    device.push(-500);
    EXPECT_EQ(device.board.force_uN, 0);
    EXPECT_EQ(device.board.last.status, fault);
    device.board.conditions = 0;
    device.push(-500);
    EXPECT_EQ(device.board.force_uN, -500);
  }
}

}  // namespace
}  // namespace palpate::bridge
