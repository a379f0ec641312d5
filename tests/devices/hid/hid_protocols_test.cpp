#include "devices/bridge/bridge_bus.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>

#include "devices/firmware/wire.h"
#include "devices/hid/hidapi_bus.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

// Devices by their ids; encoding and decoding of every report; other bytes are refused.

using Bytes = std::vector<std::uint8_t>;

ReportVerdict decode(const DeviceProtocol* protocol, const Bytes& bytes, DeviceReading& reading) {
  reading = {};
  return protocol->decode(bytes.data(), bytes.size(), reading);
}

Bytes ffb_answer(std::uint8_t type, std::int64_t position) {
  Bytes bytes(25, 0);
  bytes[0] = 0xA1;
  bytes[1] = type;
  bytes[2] = 0x01;
  bytes[3] = 0x0A;
  bytes[5] = 0x09;
  for (std::size_t i = 0; i < 8; ++i) bytes[9 + i] = static_cast<std::uint8_t>(position >> (8 * i));
  return bytes;
}

TEST(HidProtocols, AreKnownByTheIdsOfANode) {
  EXPECT_EQ(hid_protocol_of(test::found_board()), &kOpenFfBoardProtocol);
  EXPECT_EQ(hid_protocol_of(test::found_space_mouse()), &kSpaceMouseProtocol);
  EXPECT_EQ(hid_protocol_of({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 8}), &kSpaceMouseProtocol);
  EXPECT_EQ(hid_protocol_of({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 2}), nullptr) << "its other usage";
  EXPECT_EQ(hid_protocol_of({"/dev/hidraw0", "Mouse", 0x046D, 0xC077, 1, 2}), nullptr);
}

TEST(HidReports, ReadsOpenFfBoard) {
  DeviceReading reading;
  for (const std::uint8_t type : {std::uint8_t{1}, std::uint8_t{10}}) {
    ASSERT_EQ(decode(&kOpenFfBoardProtocol, ffb_answer(type, -70000), reading), ReportVerdict::position);
    EXPECT_EQ(reading.counts, -70000);
  }
  // Older firmware leaves the upper half empty.
  ASSERT_EQ(decode(&kOpenFfBoardProtocol, ffb_answer(10, 0xFFFFFFFF), reading), ReportVerdict::position);
  EXPECT_EQ(reading.counts, -1);
  EXPECT_EQ(decode(&kOpenFfBoardProtocol, ffb_answer(10, 1LL << 40), reading), ReportVerdict::corrupt);
  EXPECT_EQ(decode(&kOpenFfBoardProtocol, ffb_answer(77, 0), reading), ReportVerdict::corrupt);
  EXPECT_EQ(decode(&kOpenFfBoardProtocol, ffb_answer(15, 0), reading), ReportVerdict::nothing);
  EXPECT_TRUE(reading.own_fault);
  Bytes joystick(20, 0);
  joystick[0] = 1;
  EXPECT_EQ(decode(&kOpenFfBoardProtocol, joystick, reading), ReportVerdict::nothing);
}

TEST(HidReports, ReadsTheSpaceMouse) {
  DeviceReading reading;
  ASSERT_EQ(decode(&kSpaceMouseProtocol, {1, 0, 0, 0, 0, 0xA2, 0xFE}, reading), ReportVerdict::position);
  EXPECT_EQ(reading.counts, -350);
  ASSERT_EQ(decode(&kSpaceMouseProtocol, {1, 0, 0, 0, 0, 5, 0, 9, 9, 9, 9, 9, 9}, reading), ReportVerdict::position)
      << "the wireless ones send six axes";
  EXPECT_EQ(reading.counts, 5);
  EXPECT_EQ(decode(&kSpaceMouseProtocol, {2, 0, 0, 0, 0, 5, 0}, reading), ReportVerdict::nothing);
  EXPECT_EQ(decode(&kSpaceMouseProtocol, {3, 1}, reading), ReportVerdict::nothing);
  EXPECT_EQ(decode(&kSpaceMouseProtocol, {1, 0, 0, 0, 0, 0, 0x20}, reading), ReportVerdict::corrupt);
}

TEST(HidReports, RefusesEveryOtherLength) {
  DeviceReading reading;
  const Bytes zeros(64, 0);
  for (const DeviceProtocol* protocol : kHidProtocols) {
    EXPECT_EQ(protocol->decode(zeros.data(), 0, reading), ReportVerdict::corrupt);
    EXPECT_NE(protocol->decode(zeros.data(), 13, reading), ReportVerdict::position) << protocol->name;
  }
}

std::uint16_t ffb_object(const OutReports& reports, std::size_t i) { return wire::read16(reports.bytes[i].data() + 2); }
std::uint32_t ffb_command(const OutReports& reports, std::size_t i) {
  return wire::read32(reports.bytes[i].data() + 5);
}
std::uint32_t ffb_value(const OutReports& reports, std::size_t i) { return wire::read32(reports.bytes[i].data() + 9); }

TEST(HidReports, WritesOpenFfBoard) {
  const OutReports most = kOpenFfBoardProtocol.encode_command({1, 1, true, 1e9});
  EXPECT_EQ(ffb_value(most, 1), 32767u) << "clamped";
  const OutReports ffb = kOpenFfBoardProtocol.encode_command({1, 1, true, -2.0});
  ASSERT_EQ(ffb.count, 2u) << "asks for the position, sets the force";
  EXPECT_EQ(ffb.sizes[1], 25u);
  EXPECT_EQ(ffb.bytes[1][0], 0xA1);
  EXPECT_EQ(ffb.bytes[1][1], 3) << "write to an address";
  EXPECT_EQ(ffb_object(ffb, 1), 0xA03);
  EXPECT_EQ(ffb_command(ffb, 1), 4u);
  EXPECT_EQ(ffb_value(ffb, 1), 0xFFFFFFFEu);
  EXPECT_EQ(wire::read32(ffb.bytes[1].data() + 13), 0xFFFFFFFFu);
}

TEST(HidReports, NoNumberIsNoForce) {
  for (const DeviceProtocol* protocol : {&kBridgeProtocol, &kOpenFfBoardProtocol}) {
    const OutReports nan = protocol->encode_command({1, 1, true, std::nan("")});
    const OutReports zero = protocol->encode_command({1, 1, false, 0.0});
    EXPECT_EQ(nan.bytes, zero.bytes);
    EXPECT_EQ(protocol->encode_stop().count, 1u);
  }
  EXPECT_EQ(kSpaceMouseProtocol.encode_command({1, 1, true, 1.0}).count, 0u);
  EXPECT_EQ(kSpaceMouseProtocol.encode_stop().count, 0u);
}

// The real bus without a device. tests/devices/emulated has an emulated one.

TEST(HidapiBus, SystemErrorsHaveAdvice) {
  EXPECT_TRUE(test::has_parts(open_error_words("/dev/hidraw0", EACCES),
                              {"/dev/hidraw0", "permission", "assets/udev/70-palpate.rules", "/etc/udev/rules.d"}));
  EXPECT_TRUE(test::has_parts(open_error_words("/dev/hidraw0", EBUSY), {"/dev/hidraw0", "in use", "; "}));
  EXPECT_TRUE(test::has_parts(open_error_words("/dev/hidraw0", ENOENT), {"/dev/hidraw0", "no node", "; "}));
  EXPECT_EQ(open_error_words("/dev/hidraw0", EIO), "/dev/hidraw0: Input/output error");
}

TEST(HidapiBus, TheRealOneWorksWithoutAnyDevice) {
  for (const DeviceNode& found : system_hid_bus().list()) EXPECT_FALSE(found.path.empty());
  EXPECT_FALSE(system_hid_bus().open({"/dev/no-such-node", "", 0, 0, 0, 0}).ok());
}

}  // namespace
}  // namespace palpate
