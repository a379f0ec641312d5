#include "devices/hid/hid_reports.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "devices/firmware/paddle/paddle_protocol.h"

namespace palpate {
namespace {

using paddle::read16;
using paddle::read32;
using paddle::write16;
using paddle::write32;

constexpr std::size_t kPolhemBytes = 14;

// OpenFFBoard, from its published list of commands.
constexpr std::size_t kFfbBytes = 25;
constexpr std::uint8_t kFfbReport = 0xA1;
constexpr std::uint16_t kFfbAxis = 0xA01;
constexpr std::uint32_t kFfbPosition = 0x9;
constexpr std::uint16_t kFfbEffects = 0xA03;
constexpr std::uint32_t kFfbActive = 0x0, kFfbReset = 0x1, kFfbNew = 0x2, kFfbMagnitude = 0x4,
                        kFfbState = 0x5;
constexpr std::uint64_t kFfbConstantForce = 1;
enum FfbType : std::uint8_t {
  kWrite = 0,
  kRequest = 1,
  kWriteTo = 3,
  kAck = 10,
  kNotFound = 13,
  kNotify = 14,
  kErr = 15
};

// Far beyond any deflection of a SpaceMouse.
constexpr int kSpaceMouseMost = 1000;

ReportVerdict decode_paddle(const std::uint8_t* bytes, std::size_t size, HidReading& reading) noexcept {
  if (size != paddle::kReportBytes) return ReportVerdict::corrupt;
  paddle::FromDevice in{};
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

// There is no checksum: what can be wrong is the length and what should be 0.
ReportVerdict decode_polhem(const std::uint8_t* bytes, std::size_t size, HidReading& reading) noexcept {
  if (size != kPolhemBytes && size != kLargestHidReport) return ReportVerdict::corrupt;
  if (std::any_of(bytes + kPolhemBytes, bytes + size, [](std::uint8_t byte) { return byte != 0; })) {
    return ReportVerdict::corrupt;
  }
  reading.counts = static_cast<std::int16_t>(read16(bytes));
  return ReportVerdict::position;
}

ReportVerdict decode_openffboard(const std::uint8_t* bytes, std::size_t size, HidReading& reading) noexcept {
  if (size == 0 || bytes[0] != kFfbReport) return size == 0 ? ReportVerdict::corrupt : ReportVerdict::nothing;
  if (size != kFfbBytes) return ReportVerdict::corrupt;
  const std::uint8_t type = bytes[1];
  const bool known = type <= 4 || type == kAck || type == kNotFound || type == kNotify || type == kErr;
  if (!known) return ReportVerdict::corrupt;
  if (type == kNotFound || type == kErr) {
    reading.own_fault = true;
    return ReportVerdict::nothing;
  }
  const bool answer = type == kRequest || type == kAck;
  if (!answer || read16(bytes + 2) != kFfbAxis || bytes[4] != 0 || read32(bytes + 5) != kFfbPosition) {
    return ReportVerdict::nothing;
  }
  // A 64-bit field for a 32-bit position: the upper half only repeats the sign.
  const auto low = static_cast<std::int32_t>(read32(bytes + 9));
  const std::uint32_t high = read32(bytes + 13);
  if (high != 0 && high != 0xFFFFFFFFu) return ReportVerdict::corrupt;
  reading.counts = low;
  return ReportVerdict::position;
}

ReportVerdict decode_spacemouse(const std::uint8_t* bytes, std::size_t size, HidReading& reading) noexcept {
  if (size == 0) return ReportVerdict::corrupt;
  if (bytes[0] != 1) return ReportVerdict::nothing;  // rotation, buttons, battery
  if (size < 7) return ReportVerdict::corrupt;
  for (const std::size_t at : {1u, 3u, 5u}) {
    if (std::abs(static_cast<std::int16_t>(read16(bytes + at))) > kSpaceMouseMost)
      return ReportVerdict::corrupt;
  }
  reading.counts = static_cast<std::int16_t>(read16(bytes + 5));
  return ReportVerdict::position;
}

std::int16_t as_int16(double units) noexcept {
  if (!std::isfinite(units)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(units, -32767.0, 32767.0)));
}

// Appends room for a report of `size` bytes behind its id.
std::uint8_t* append(OutReports& reports, std::uint8_t id, std::size_t size) noexcept {
  std::uint8_t* bytes = reports.bytes[reports.count].data();
  bytes[0] = id;
  reports.sizes[reports.count] = size + 1;
  ++reports.count;
  return bytes + 1;
}

void append_ffb(OutReports& reports, FfbType type, std::uint16_t object, std::uint32_t command,
                std::uint64_t data, std::uint64_t address) noexcept {
  std::uint8_t* at = append(reports, kFfbReport, kFfbBytes - 1);
  at[0] = type;
  write16(at + 1, object);
  at[3] = 0;
  write32(at + 4, command);
  write32(at + 8, static_cast<std::uint32_t>(data));
  write32(at + 12, static_cast<std::uint32_t>(data >> 32));
  write32(at + 16, static_cast<std::uint32_t>(address));
  write32(at + 20, static_cast<std::uint32_t>(address >> 32));
}

void append_ffb_force(OutReports& reports, std::int16_t magnitude) noexcept {
  const auto data = static_cast<std::uint64_t>(static_cast<std::int64_t>(magnitude));
  append_ffb(reports, kWriteTo, kFfbEffects, kFfbMagnitude, data, 0);
}

}  // namespace

const char* hid_kind_name(HidKind kind) noexcept {
  switch (kind) {
    case HidKind::paddle:
      return "paddle";
    case HidKind::polhem:
      return "polhem";
    case HidKind::openffboard:
      return "openffboard";
    case HidKind::spacemouse:
      return "spacemouse";
  }
  return "";
}

ReportVerdict decode_report(HidKind kind, const std::uint8_t* bytes, std::size_t size,
                            HidReading& reading) noexcept {
  reading = {};
  switch (kind) {
    case HidKind::paddle:
      return decode_paddle(bytes, size, reading);
    case HidKind::polhem:
      return decode_polhem(bytes, size, reading);
    case HidKind::openffboard:
      return decode_openffboard(bytes, size, reading);
    case HidKind::spacemouse:
      return decode_spacemouse(bytes, size, reading);
  }
  return ReportVerdict::corrupt;
}

OutReports encode_start(HidKind kind) noexcept {
  if (kind != HidKind::openffboard) return encode_stop(kind);
  OutReports reports;
  append_ffb(reports, kRequest, kFfbEffects, kFfbReset, 0, 0);
  append_ffb(reports, kWrite, kFfbEffects, kFfbNew, kFfbConstantForce, 0);
  append_ffb(reports, kWriteTo, kFfbEffects, kFfbState, 1, 0);
  append_ffb(reports, kWrite, kFfbEffects, kFfbActive, 1, 0);
  return reports;
}

OutReports encode_command(HidKind kind, const HidCommand& command) noexcept {
  OutReports reports;
  const std::int16_t units = command.drive ? as_int16(command.units) : static_cast<std::int16_t>(0);
  switch (kind) {
    case HidKind::paddle:
      paddle::encode(paddle::FromHost{command.drive ? paddle::kDrive : std::uint8_t{0}, command.sequence,
                                      units, command.heartbeat},
                     append(reports, 0, paddle::kReportBytes));
      break;
    case HidKind::polhem:
      write16(append(reports, 0, kLargestHidReport), static_cast<std::uint16_t>(units));
      break;
    case HidKind::openffboard:
      append_ffb(reports, kRequest, kFfbAxis, kFfbPosition, 0, 0);
      append_ffb_force(reports, units);
      break;
    case HidKind::spacemouse:
      break;
  }
  return reports;
}

OutReports encode_stop(HidKind kind) noexcept {
  OutReports reports;
  if (kind == HidKind::openffboard) {
    append_ffb_force(reports, 0);
    return reports;
  }
  return encode_command(kind, {});
}

}  // namespace palpate
