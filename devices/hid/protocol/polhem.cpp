#include "devices/hid/protocol/polhem.h"

#include <algorithm>

#include "devices/firmware/paddle/paddle_protocol.h"
#include "devices/hid/protocol/paddle.h"

namespace palpate {
namespace {

constexpr std::size_t kPolhemBytes = 14;

// There is no checksum: what can be wrong is the length and what should be 0.
ReportVerdict decode_polhem(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size != kPolhemBytes && size != kLargestHidReport) return ReportVerdict::corrupt;
  if (std::any_of(bytes + kPolhemBytes, bytes + size, [](std::uint8_t byte) { return byte != 0; })) {
    return ReportVerdict::corrupt;
  }
  reading.counts = static_cast<std::int16_t>(paddle::read16(bytes));
  return ReportVerdict::position;
}

OutReports encode_polhem(const HidCommand& command) noexcept {
  OutReports reports;
  paddle::write16(append_report(reports, 0, kLargestHidReport), static_cast<std::uint16_t>(int16_units(command)));
  return reports;
}

OutReports stop_polhem() noexcept { return encode_polhem({}); }

}  // namespace

const HidDriver kPolhemDriver = {
    .name = "polhem",
    .description = "Polhem / WoodenHaptics, one axis",
    .firmware = "devices/firmware/paddle",
    .version = 0,
    .renders_force = true,
    .reports_unasked = true,
    .numbers_reports = false,
    .count_bits = 16,
    .matches = is_raw_hid_teensy,
    .decode = decode_polhem,
    .encode_start = stop_polhem,
    .encode_command = encode_polhem,
    .encode_stop = stop_polhem,
};

}  // namespace palpate
