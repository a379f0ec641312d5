// The frames of the bridge, byte for byte, and the finder of frames in a stream.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_protocol.h"
#include "engine/base/random_stream.h"

namespace palpate {
namespace {

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

}  // namespace
}  // namespace palpate
