#include "devices/bridge/bridge_bus.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "engine/base/signals.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

constexpr int kRead_ms = 50;  // short, so that the reader thread ends soon after it is stopped
// A board that resets takes two seconds; a program with an SDK may search for its device first.
constexpr double kFirstFrame_s = 4.0, kFirstFrameOfProgram_s = 20.0;
constexpr int kFramesToInspect = 8;

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

int BridgeConnection::read(std::uint8_t* bytes, std::size_t capacity) noexcept {
  if (capacity < bridge::kDeviceBytes) return 0;
  if (const int size = reports_.next(next_, end_, bytes); size > 0) return size;
  const int came = stream_->read(bytes_, sizeof bytes_, kRead_ms);
  if (came <= 0) return came;
  next_ = bytes_;
  end_ = bytes_ + came;
  for (const std::uint8_t* at = next_; at != end_ && !reports_.any_frame() && first_count_ < sizeof first_;) {
    first_[first_count_++] = *at++;
  }
  return reports_.next(next_, end_, bytes);
}

std::string BridgeConnection::garbage() const {
  std::string text;
  for (std::size_t i = 0; i < first_count_; ++i) {
    const bool printable = std::isprint(first_[i]) != 0;
    if (!printable && first_[i] != '\n' && first_[i] != '\r') return {};
    text += printable ? static_cast<char>(first_[i]) : ' ';
  }
  return text;
}

BridgeBus::BridgeBus(BridgeTarget target, const std::string& text) : target_(std::move(target)) {
  info_.path = "bridge:" + text;
}

Result<std::unique_ptr<DeviceConnection>> BridgeBus::open(const DeviceNode&) {
  Result<std::unique_ptr<ByteStream>> stream = ByteStream::open(target_);
  if (!stream) return stream.error();
  return Result<std::unique_ptr<DeviceConnection>>(std::make_unique<BridgeConnection>(std::move(*stream)));
}

Result<OpenedDevice> BridgeBus::open_and_identify() {
  ignore_broken_pipes();  // so that a write to a program that has ended returns an error
  Result<std::unique_ptr<DeviceConnection>> opened = open(info_);
  if (!opened) return opened.error();
  auto& connection = static_cast<BridgeConnection&>(**opened);
  const OutReports start = kBridgeProtocol.encode_start();
  connection.write(start.bytes[0].data(), start.sizes[0]);
  OpenedDevice result;
  int frames = 0;
  double last_sent_s = steady_now_s();
  const double patience_s = target_.kind == BridgeTarget::Kind::command ? kFirstFrameOfProgram_s : kFirstFrame_s;
  for (const double until_s = last_sent_s + patience_s; frames < kFramesToInspect && steady_now_s() < until_s;) {
    if (stop_requested() != 0) return Error{"interrupted"};
    std::uint8_t bytes[kLargestReport];
    const int size = connection.read(bytes, sizeof bytes);
    if (size < 0) {
      const std::string said = connection.garbage();
      return Error{info_.path + ": " + connection.end_words() + (said.empty() ? "" : ", after \"" + said + "\"") +
                   "; run it by itself to see why"};
    }
    // Opening the line may reset the board, which then misses the first frame.
    if (steady_now_s() - last_sent_s > 0.1) {
      connection.write(start.bytes[0].data(), start.sizes[0]);
      last_sent_s = steady_now_s();
    }
    if (size == 0) continue;
    DeviceReading reading;
    const ReportVerdict verdict = kBridgeProtocol.decode(bytes, static_cast<std::size_t>(size), reading);
    if (verdict == ReportVerdict::wrong_version) {
      return Error{info_.path + ": speaks version " + std::to_string(reading.version) +
                   " of the bridge protocol, expected " + std::to_string(bridge::kVersion) +
                   "; update the device's program (devices/README.md#bridge)"};
    }
    if (verdict != ReportVerdict::position) continue;
    ++frames;
    result.measures_force = result.measures_force || reading.measured_N == reading.measured_N;
  }
  if (frames < kFramesToInspect) {
    const std::string said = connection.garbage();
    if (frames > 0) {
      return Error{info_.path + ": found " + std::to_string(frames) + " frames in " + fixed(patience_s, 0) +
                   " s, expected 100 to 10000 a second"};
    }
    if (!said.empty()) return Error{info_.path + ": found text, expected frames of 28 bytes: \"" + said + "\""};
    return Error{info_.path + ": no frame within " + fixed(patience_s, 0) +
                 " s; check that the device's program runs and that the baud rate is right"};
  }
  result.info = info_;
  result.info.product = result.measures_force ? "measures force" : "measures no force";
  if (target_.remote) result.info.product += ", on a network, which adds delay";
  result.protocol = &kBridgeProtocol;
  result.connection = std::move(*opened);
  return Result<OpenedDevice>(std::move(result));
}

}  // namespace palpate
