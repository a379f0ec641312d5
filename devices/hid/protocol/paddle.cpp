#include "devices/hid/protocol/paddle.h"

#include "devices/firmware/paddle/paddle_protocol.h"

namespace palpate {
namespace {

constexpr std::uint16_t kTeensy = 0x16C0;
constexpr std::uint16_t kRawHidPage = 0xFFAB;

ReportVerdict decode_paddle(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size != paddle::kReportBytes) return ReportVerdict::corrupt;
  paddle::FromDevice in{};
  reading.version = bytes[1];
  switch (paddle::decode(bytes, in)) {
    case paddle::kGood:
      break;
    case paddle::kBadVersion:
      return ReportVerdict::wrong_version;
    default:
      return ReportVerdict::corrupt;
  }
  reading.counts = in.counts;
  reading.sequence = in.sequence;
  reading.time_us = in.time_us;
  reading.confirmed = in.confirmed;
  reading.boot = in.boot;
  reading.grip = (in.status & paddle::kGrip) != 0;
  reading.own_fault = (in.status & (paddle::kMotorFault | paddle::kEncoderFault)) != 0;
  return ReportVerdict::position;
}

OutReports encode_paddle(const HidCommand& command) noexcept {
  OutReports reports;
  paddle::encode(paddle::FromHost{command.drive ? paddle::kDrive : std::uint8_t{0}, command.sequence,
                                  int16_units(command), command.heartbeat},
                 append_report(reports, 0, paddle::kReportBytes));
  return reports;
}

OutReports stop_paddle() noexcept { return encode_paddle({}); }

// A Teensy with its raw HID interface (its other one is for messages to a console).
bool is_raw_hid_teensy(const HidDeviceInfo& info) noexcept {
  return info.vendor_id == kTeensy && (info.product_id == 0x0486 || info.product_id == 0x0480) &&
         info.usage_page == kRawHidPage;
}

}  // namespace

const HidDriver kPaddleDriver = {
    .name = "paddle",
    .description = "haptic paddle",
    .firmware = "devices/firmware/paddle",
    .version = paddle::kVersion,
    .renders_force = true,
    .reports_unasked = true,
    .numbers_reports = true,
    .tried = "on real hardware: no; on an emulated device: yes",
    .matches = is_raw_hid_teensy,
    .decode = decode_paddle,
    .encode_start = stop_paddle,
    .encode_command = encode_paddle,
    .encode_stop = stop_paddle,
};

}  // namespace palpate
