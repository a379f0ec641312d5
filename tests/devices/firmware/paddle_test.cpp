// The protocol, and the reference firmware on a simulated board.
#include "devices/firmware/paddle/paddle_firmware.h"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <fstream>
#include <sstream>
#include <string>

namespace palpate::paddle {
namespace {

using Report = std::array<uint8_t, kReportBytes>;

Report from_host(uint8_t flags, uint32_t sequence, int16_t current_mA, uint16_t heartbeat) {
  Report report{};
  encode(FromHost{flags, sequence, current_mA, heartbeat}, report.data());
  return report;
}

class SimulatedBoard final : public Board {
 public:
  uint32_t now_us() override { return time_us; }
  int32_t counts() override { return -7; }
  bool encoder_fault() override { return bad_encoder; }
  bool motor_fault() override { return bad_motor; }
  bool grip() override { return true; }
  void set_current_mA(int16_t value) override { current_mA = value; }
  bool receive(uint8_t* report) override {
    if (inbox.empty()) return false;
    std::copy(inbox.front().begin(), inbox.front().end(), report);
    inbox.pop_front();
    return true;
  }
  void send(const uint8_t* report) override {
    ++sent;
    EXPECT_EQ(decode(report, last), kGood);
  }

  uint32_t time_us = 4'294'000'000u;  // wraps within the test
  bool bad_encoder = false, bad_motor = false;
  int16_t current_mA = 99;
  int sent = 0;
  std::deque<Report> inbox;
  FromDevice last{};
};

struct Paddle {
  SimulatedBoard board;
  Firmware firmware{board, 1000, 42};
  uint32_t sequence = 0;
  uint16_t heartbeat = 0;

  void run_us(uint32_t span_us) {
    for (uint32_t i = 0; i < span_us; i += 100) {
      board.time_us += 100;
      firmware.loop();
    }
  }
  void push(int16_t current_mA) {
    board.inbox.push_back(from_host(kDrive, ++sequence, current_mA, ++heartbeat));
    run_us(1000);
  }
};

TEST(PaddleProtocol, ReadsBackWhatItWrote) {
  const FromDevice in = {kDriving | kGrip, 0x89ABCDEF, 0xFEDCBA98, -123456, -32768, 65535, 0x01020304, 77};
  Report report{};
  encode(in, report.data());
  FromDevice back{};
  ASSERT_EQ(decode(report.data(), back), kGood);
  EXPECT_EQ(back.status, in.status);
  EXPECT_EQ(back.sequence, in.sequence);
  EXPECT_EQ(back.time_us, in.time_us);
  EXPECT_EQ(back.counts, in.counts);
  EXPECT_EQ(back.current_mA, in.current_mA);
  EXPECT_EQ(back.boot, in.boot);
  EXPECT_EQ(back.confirmed, in.confirmed);
  EXPECT_EQ(back.rejected, in.rejected);
}

TEST(PaddleProtocol, HasItsBytesWhereThePageSays) {
  Report report{};
  encode(FromDevice{2, 0x04030201, 0x0D0C0B0A, 0x11223344, 0x5566, 0x7788, 0x0A0B0C0D, 0x0E0F}, report.data());
  const Report::value_type expected[] = {0x50, 1,    0x49, 2,    1,    2,    3,    4,    0x0A, 0x0B, 0x0C, 0x0D, 0x44,
                                         0x33, 0x22, 0x11, 0x66, 0x55, 0x88, 0x77, 0x0D, 0x0C, 0x0B, 0x0A, 0x0F, 0x0E};
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(report[i], expected[i]) << i;
  for (std::size_t i = std::size(expected); i < kChecksumAt; ++i) EXPECT_EQ(report[i], 0) << i;
  const Report out = from_host(kDrive, 0x04030201, -2, 0x0605);
  const Report::value_type expected_out[] = {0x50, 1, 0x4F, 1, 1, 2, 3, 4, 0xFE, 0xFF, 5, 6};
  for (std::size_t i = 0; i < std::size(expected_out); ++i) EXPECT_EQ(out[i], expected_out[i]) << i;
}

TEST(PaddleProtocol, ChecksumIsThatOfIeee8023) {
  EXPECT_EQ(crc32(reinterpret_cast<const uint8_t*>("123456789"), 9), 0xCBF43926u);
}

TEST(PaddleProtocol, AnyChangedBitIsFound) {
  const Report good = from_host(kDrive, 5, 100, 3);
  for (std::size_t bit = 0; bit < 8 * kReportBytes; ++bit) {
    Report report = good;
    report[bit / 8] = static_cast<uint8_t>(report[bit / 8] ^ (1u << (bit % 8)));
    FromHost out{};
    EXPECT_NE(decode(report.data(), out), kGood) << bit;
  }
}

TEST(PaddleProtocol, SaysWhatIsWrong) {
  Report report = from_host(kDrive, 5, 100, 3);
  FromDevice in{};
  EXPECT_EQ(decode(report.data(), in), kBadKind);
  report[1] = 2;
  EXPECT_EQ(decode(report.data(), in), kBadVersion);
  report[0] = 0;
  EXPECT_EQ(decode(report.data(), in), kBadMagic);
  FromHost out{};
  report = from_host(kDrive, 5, 100, 3);
  report[40] = 1;
  EXPECT_EQ(decode(report.data(), out), kBadChecksum);
  EXPECT_EQ(decode(from_host(128, 5, 100, 3).data(), out), kBadContent);
}

TEST(PaddleFirmware, ReportsEveryMillisecondAndDrivesAsAsked) {
  Paddle paddle;
  EXPECT_EQ(paddle.board.current_mA, 0) << "off from the first instruction";
  paddle.push(0);
  for (int i = 0; i < 100; ++i) paddle.push(300);
  EXPECT_EQ(paddle.board.current_mA, 300);
  EXPECT_NEAR(paddle.board.sent, 101, 1);
  EXPECT_EQ(paddle.board.last.status, kDriving | kGrip);
  EXPECT_EQ(paddle.board.last.counts, -7);
  EXPECT_EQ(paddle.board.last.boot, 42);
  EXPECT_NEAR(paddle.board.last.confirmed, paddle.sequence, 1);
  EXPECT_NEAR(paddle.board.last.time_us, 101'000, 1000) << "across the wrap of the clock";
}

TEST(PaddleFirmware, StopsByItselfWithin50Milliseconds) {
  Paddle paddle;
  paddle.push(0);
  paddle.push(300);
  paddle.run_us(48'000);
  EXPECT_EQ(paddle.board.current_mA, 300);
  paddle.run_us(2000);
  EXPECT_EQ(paddle.board.current_mA, 0);
  paddle.run_us(1000);
  EXPECT_EQ(paddle.board.last.status, kStopped | kGrip);
  paddle.push(300);
  EXPECT_EQ(paddle.board.current_mA, 0) << "not in the middle of a push";
  paddle.push(0);
  paddle.push(300);
  EXPECT_EQ(paddle.board.current_mA, 300);
}

TEST(PaddleFirmware, StopsWhenOnlyTheUsbThreadOfTheHostLives) {
  Paddle paddle;
  paddle.push(0);
  paddle.push(300);
  for (int i = 0; i < 51; ++i) {
    paddle.board.inbox.push_back(from_host(kDrive, ++paddle.sequence, 300, paddle.heartbeat));
    paddle.run_us(1000);
  }
  EXPECT_EQ(paddle.board.current_mA, 0);
}

TEST(PaddleFirmware, ObeysOnlyNewReportsUnlessTheyStop) {
  Paddle paddle;
  paddle.push(0);
  paddle.push(300);
  paddle.board.inbox.push_back(from_host(kDrive, paddle.sequence, 900, 77));
  paddle.board.inbox.push_back(from_host(kDrive, paddle.sequence - 1, 900, 78));
  Report bad = from_host(kDrive, paddle.sequence + 1, 900, 79);
  bad[8] ^= 1;
  paddle.board.inbox.push_back(bad);
  paddle.run_us(2000);
  EXPECT_EQ(paddle.board.current_mA, 300);
  EXPECT_EQ(paddle.board.last.rejected, 3);
  paddle.board.inbox.push_back(from_host(0, 0, 0, 0));
  paddle.run_us(100);
  EXPECT_EQ(paddle.board.current_mA, 0);
}

TEST(PaddleFirmware, ClampsAndStopsOnAFaultOfItsOwn) {
  Paddle paddle;
  paddle.push(0);
  paddle.push(32000);
  EXPECT_EQ(paddle.board.current_mA, 1000);
  paddle.push(-32768);
  EXPECT_EQ(paddle.board.current_mA, -1000);
  paddle.board.bad_motor = true;
  paddle.push(-500);
  EXPECT_EQ(paddle.board.current_mA, 0);
  EXPECT_EQ(paddle.board.last.status & kMotorFault, kMotorFault);
  paddle.board.bad_motor = false;
  paddle.board.bad_encoder = true;
  paddle.push(0);
  paddle.push(500);
  EXPECT_EQ(paddle.board.current_mA, 0);
}

}  // namespace
}  // namespace palpate::paddle
