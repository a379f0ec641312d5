// OpenFFBoard in its mode "HID Gamepad (Ext FFB)": position of axis 0, one constant force in 1/32767 of the full force.
// Vendor report 0xA1, 25 bytes: type u8, class u16, instance u8, command u32, data u64, address u64. The force ends 50
// ms after the host renewed it last. Firmware without durations refuses that command: a fault of the device.
// Source: the published list of commands and the source of the effects manager of OpenFFBoard.
#include <algorithm>
#include <cmath>

#include "devices/firmware/wire.h"
#include "devices/hid/hidapi_bus.h"

namespace palpate {
namespace {

constexpr std::uint16_t kFfbVendor = 0x1209, kFfbProduct = 0xFFB0;
constexpr std::size_t kFfbBytes = 25;
constexpr std::uint8_t kFfbReport = 0xA1;
constexpr std::uint16_t kFfbAxis = 0xA01;
constexpr std::uint32_t kFfbPosition = 0x9;
constexpr std::uint16_t kFfbEffects = 0xA03;
constexpr std::uint32_t kFfbActive = 0x0, kFfbReset = 0x1, kFfbNew = 0x2, kFfbMagnitude = 0x4, kFfbState = 0x5,
                        kFfbDuration = 0x7;
constexpr std::uint64_t kFfbConstantForce = 1;
// The force ends this long after its last start; boards of the bridge have the same time.
constexpr std::uint64_t kFfbDuration_ms = 50;
// Every fourth command starts the force again. Commands are at most 5 ms apart (DeviceEndpoint::kRepeat_s), so that one
// start may be lost. A start with every command would need a third report each millisecond.
constexpr std::uint32_t kFfbRenewEvery = 4;
// Types of reports.
constexpr std::uint8_t kWrite = 0, kRequest = 1, kWriteTo = 3, kAck = 10, kNotFound = 13, kNotify = 14, kErr = 15;

ReportVerdict decode_openffboard(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size > 0 && bytes[0] != kFfbReport) return ReportVerdict::nothing;
  if (size != kFfbBytes) return ReportVerdict::corrupt;
  const std::uint8_t type = bytes[1];
  const bool known = type <= 4 || type == kAck || type == kNotFound || type == kNotify || type == kErr;
  if (!known) return ReportVerdict::corrupt;
  if (type == kNotFound || type == kErr) {
    reading.own_fault = true;
    return ReportVerdict::nothing;
  }
  const bool answer = type == kRequest || type == kAck;
  if (!answer || wire::read16(bytes + 2) != kFfbAxis || bytes[4] != 0 || wire::read32(bytes + 5) != kFfbPosition)
    return ReportVerdict::nothing;
  // The field of 64 bits has a position of 32 bits; the upper half repeats the sign.
  const auto low = static_cast<std::int32_t>(wire::read32(bytes + 9));
  const std::uint32_t high = wire::read32(bytes + 13);
  if (high != 0 && high != 0xFFFFFFFFu) return ReportVerdict::corrupt;
  reading.counts = low;
  return ReportVerdict::position;
}

void append_ffb(OutReports& reports, std::uint8_t type, std::uint16_t object, std::uint32_t command,
                std::uint64_t data) noexcept {
  reports.sizes[reports.count] = kFfbBytes;
  std::uint8_t* at = reports.bytes[reports.count++].data();
  *at++ = kFfbReport;
  at[0] = type;
  wire::write16(at + 1, object);
  at[3] = 0;
  wire::write32(at + 4, command);
  wire::write32(at + 8, static_cast<std::uint32_t>(data));
  wire::write32(at + 12, static_cast<std::uint32_t>(data >> 32));
  // The address: axis 0 or effect 0.
  wire::write32(at + 16, 0);
  wire::write32(at + 20, 0);
}

void append_ffb_force(OutReports& reports, double units) noexcept {
  const std::int64_t magnitude = std::lround(std::clamp(units, -32767.0, 32767.0));
  append_ffb(reports, kWriteTo, kFfbEffects, kFfbMagnitude, static_cast<std::uint64_t>(magnitude));
}

// A new effect has no end. It gets its duration here, before the commands start it.
OutReports start_openffboard() noexcept {
  OutReports reports;
  append_ffb(reports, kRequest, kFfbEffects, kFfbReset, 0);
  append_ffb(reports, kWrite, kFfbEffects, kFfbNew, kFfbConstantForce);
  append_ffb(reports, kWriteTo, kFfbEffects, kFfbDuration, kFfbDuration_ms);
  append_ffb(reports, kWrite, kFfbEffects, kFfbActive, 1);
  return reports;
}

OutReports encode_openffboard(const DeviceCommand& command) noexcept {
  OutReports reports;
  append_ffb(reports, kRequest, kFfbAxis, kFfbPosition, 0);
  append_ffb_force(reports, command.drive && std::isfinite(command.units) ? command.units : 0.0);
  if (command.sequence % kFfbRenewEvery == 0) append_ffb(reports, kWriteTo, kFfbEffects, kFfbState, 1);
  return reports;
}

OutReports stop_openffboard() noexcept {
  OutReports reports;
  append_ffb_force(reports, 0.0);
  return reports;
}

}  // namespace

const DeviceProtocol kOpenFfBoardProtocol = {
    .name = "openffboard",
    .description = "OpenFFBoard, one axis",
    .renders_force = true,
    .matches =
        [](const DeviceNode& node) noexcept { return node.vendor_id == kFfbVendor && node.product_id == kFfbProduct; },
    .decode = decode_openffboard,
    .encode_start = start_openffboard,
    .encode_command = encode_openffboard,
    .encode_stop = stop_openffboard,
};

}  // namespace palpate
