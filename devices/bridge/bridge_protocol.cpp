// The protocol of `--device bridge:TARGET`: each report is one frame (devices/firmware/bridge_protocol.h).
#include <algorithm>
#include <cmath>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_protocol.h"

namespace palpate {
namespace {

// The limits of a recording; larger values are invalid.
constexpr std::int32_t kMost_nm = 1'000'000'000;
constexpr double kMost_uN = 2e9;

ReportVerdict decode_bridge(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size == 4) {
    reading.version = bytes[2];
    return ReportVerdict::wrong_version;
  }
  bridge::FromDevice in{};
  if (size != bridge::kDeviceBytes || !bridge::decode(bytes, in)) return ReportVerdict::corrupt;
  if (in.position_nm > kMost_nm || in.position_nm < -kMost_nm) return ReportVerdict::corrupt;
  reading.counts = in.position_nm;
  reading.sequence = in.sequence;
  reading.time_us = in.time_us;
  reading.confirmed = in.confirmed;
  if (in.force_uN != bridge::kNoForce) reading.measured_N = in.force_uN / 1e6;
  reading.grip = (in.status & bridge::kGrip) != 0;
  reading.own_fault = (in.status & (bridge::kMotorFault | bridge::kSensorFault)) != 0;
  reading.driving = (in.status & bridge::kDriving) != 0;
  reading.stopped = (in.status & bridge::kStopped) != 0;
  return ReportVerdict::position;
}

OutReports encode_bridge(const DeviceCommand& command) noexcept {
  bridge::FromHost out{};
  out.sequence = command.sequence;
  out.heartbeat = command.heartbeat;
  if (command.drive && std::isfinite(command.units)) {
    out.flags = bridge::kDrive;
    out.force_uN = static_cast<std::int32_t>(std::lround(std::clamp(-command.units, -kMost_uN, kMost_uN)));
  }
  OutReports reports;
  bridge::encode(out, reports.bytes[0].data());
  reports.sizes[0] = bridge::kHostBytes;
  reports.count = 1;
  return reports;
}

OutReports stop_bridge() noexcept { return encode_bridge({}); }

}  // namespace

const DeviceProtocol kBridgeProtocol = {
    .name = "bridge",
    .description = "bridge",
    .renders_force = true,
    .absolute = true,
    .timed = true,
    .confirms = true,
    .matches = [](const DeviceNode&) noexcept { return true; },  // a BridgeBus has no other devices
    .decode = decode_bridge,
    .encode_start = stop_bridge,
    .encode_command = encode_bridge,
    .encode_stop = stop_bridge,
};

}  // namespace palpate
