// 3Dconnexion's SpaceMouse: report 1 begins with three int16 translations. z is used; it is positive when the cap is
// pushed down. The host writes no reports.
#include "devices/hid/spacemouse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "devices/firmware/wire.h"
#include "devices/hid/hid_protocols.h"

namespace palpate {
namespace {

constexpr std::uint16_t k3Dconnexion = 0x256F, kLogitech = 0x046D;
// Product ids with Logitech's vendor id; later products have the vendor id of 3Dconnexion.
constexpr std::array<std::uint16_t, 7> kSpaceMice = {0xC626, 0xC627, 0xC628, 0xC629, 0xC62B, 0xC62E, 0xC62F};
constexpr std::uint16_t kDesktopPage = 1, kMultiAxis = 8;
// Larger values are invalid; every deflection is far below.
constexpr int kSpaceMouseMost = 1000;

bool is_space_mouse(const DeviceNode& info) noexcept {
  if (info.usage_page != kDesktopPage || info.usage != kMultiAxis) return false;
  return info.vendor_id == k3Dconnexion ||
         (info.vendor_id == kLogitech &&
          std::find(kSpaceMice.begin(), kSpaceMice.end(), info.product_id) != kSpaceMice.end());
}

ReportVerdict decode_space_mouse(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size == 0) return ReportVerdict::corrupt;
  if (bytes[0] != 1) return ReportVerdict::nothing;  // rotation, buttons, battery
  if (size < 7) return ReportVerdict::corrupt;
  for (const std::size_t at : {1u, 3u, 5u}) {
    if (std::abs(static_cast<std::int16_t>(wire::read16(bytes + at))) > kSpaceMouseMost) return ReportVerdict::corrupt;
  }
  reading.counts = static_cast<std::int16_t>(wire::read16(bytes + 5));
  return ReportVerdict::position;
}

OutReports no_report() noexcept { return {}; }
OutReports no_command(const DeviceCommand&) noexcept { return {}; }

constexpr double kHold_s = 0.1;  // as in StreamMonitor

}  // namespace

const DeviceProtocol kSpaceMouseProtocol = {
    .name = "spacemouse",
    .description = "SpaceMouse, input only: no force",
    .renders_force = false,
    .matches = is_space_mouse,
    .decode = decode_space_mouse,
    .encode_start = no_report,
    .encode_command = no_command,
    .encode_stop = no_report,
};

void SpaceMouseAxis::connected(double) noexcept {
  deflection_.connected = true;
  newest_.write(deflection_);
}

void SpaceMouseAxis::unplugged() noexcept {
  deflection_.connected = false;
  deflection_.counts = 0.0;
  ++deflection_.reports;
  newest_.write(deflection_);
}

void SpaceMouseAxis::report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept {
  DeviceReading reading;
  switch (calibration_.protocol->decode(bytes, size, reading)) {
    case ReportVerdict::position:
      break;
    case ReportVerdict::corrupt:
      deflection_.corrupt_until_s = now_s + kHold_s;
      newest_.write(deflection_);
      return;
    default:
      return;
  }
  deflection_.interval_s = std::clamp(now_s - deflection_.at_s, kShortest_s, kLongest_s);
  deflection_.at_s = now_s;
  deflection_.counts = std::abs(reading.counts) < kDeadCounts ? 0.0 : reading.counts;
  ++deflection_.reports;
  newest_.write(deflection_);
}

double SpaceMouseAxis::target_m(double now_s) noexcept {
  const Deflection& newest = newest_.newest();
  const auto shown = [&] {
    const double share = std::clamp((now_s - since_s_) / over_s_, 0.0, 1.0);
    return from_counts_ + share * (to_counts_ - from_counts_);
  };
  if (newest.reports != seen_) {
    seen_ = newest.reports;
    from_counts_ = shown();
    to_counts_ = newest.counts;
    since_s_ = now_s;
    over_s_ = newest.interval_s;
  }
  return calibration_.rest_position_m + calibration_.direction * shown() / calibration_.counts_per_metre;
}

void SpaceMouseAxis::drive(MouseDevice& tool, double now_s) noexcept {
  const double target = target_m(now_s);
  if (seen_ == 0) return;
  if (target != last_target_m_) tool.set_target(target, now_s);
  last_target_m_ = target;
}

DeviceHealth SpaceMouseAxis::health(double now_s) noexcept {
  const Deflection& newest = newest_.newest();
  DeviceHealth health;
  if (!newest.connected) health.faults |= device_fault::kUnplugged;
  if (now_s < newest.corrupt_until_s) health.faults |= device_fault::kCorrupt;
  return health;
}

SpaceMouse::SpaceMouse(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened)
    : axis_(calibration), link_(bus, axis_, std::move(opened)) {}

}  // namespace palpate
