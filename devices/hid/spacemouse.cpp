#include "devices/hid/spacemouse.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/live/device_health.h"

namespace palpate {
namespace {

constexpr double kHold_s = 0.1;  // as in StreamMonitor

}  // namespace

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
