#include "devices/bridge/bridge_bus.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <utility>

#include "devices/hid/device_stop.h"
#include "devices/hid/hid_drivers.h"
#include "engine/base/signals.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

constexpr int kRead_ms = 50;  // so that a reader soon sees that it should end
// A board that resets takes two seconds, a program with an SDK may look for its device.
constexpr double kFirstFrame_s = 4.0, kFirstFrameOfProgram_s = 20.0;
constexpr int kFramesToInspect = 8;

}  // namespace

BridgeConnection::~BridgeConnection() { unregister_device_stop(stop_slot_); }

int BridgeConnection::read(std::uint8_t* bytes, std::size_t capacity) noexcept {
  if (capacity < bridge::kDeviceBytes) return 0;
  if (!frame_waits_ && next_ == count_) {
    const int came = stream_->read(bytes_, sizeof bytes_, kRead_ms);
    if (came <= 0) return came;
    next_ = 0;
    count_ = static_cast<std::size_t>(came);
  }
  bool found = std::exchange(frame_waits_, false);
  while (!found && next_ < count_) {
    if (!any_frame_ && first_count_ < sizeof first_) first_[first_count_++] = bytes_[next_];
    found = finder_.add(bytes_[next_++]);
  }
  // What a stream begins with may be the rest of a frame.
  const bool gap = any_frame_ && finder_.skipped() != skipped_;
  skipped_ = finder_.skipped();
  any_frame_ = any_frame_ || found;
  if (!found && finder_.other_version() != 0) {
    const std::uint8_t header[4] = {0x50, 0x42, finder_.other_version(), bridge::kFromDevice};
    std::copy(header, header + 4, bytes);
    finder_ = {};
    skipped_ = 0;
    return 4;
  }
  if (gap) {
    frame_waits_ = found;
    bytes[0] = 0;
    return 1;
  }
  if (!found) return 0;
  std::memcpy(bytes, finder_.frame(), bridge::kDeviceBytes);
  return static_cast<int>(bridge::kDeviceBytes);
}

bool BridgeConnection::write(const std::uint8_t* bytes, std::size_t size) noexcept {
  if (!begin_force_write()) return false;
  const bool taken = stream_->write(bytes, size);
  end_force_write();
  return taken;
}

void BridgeConnection::stop_with(const OutReports& reports) noexcept {
  unregister_device_stop(stop_slot_);
  stop_slot_ = register_device_stop(stream_->descriptor(), reports);
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
  info_.path = std::string(kBridgePath) + text;
}

Result<std::unique_ptr<HidConnection>> BridgeBus::open(const HidDeviceInfo&) {
  Result<std::unique_ptr<ByteStream>> stream = ByteStream::open(target_);
  if (!stream) return stream.error();
  return Result<std::unique_ptr<HidConnection>>(std::make_unique<BridgeConnection>(std::move(*stream)));
}

Result<HidOpened> BridgeBus::open_and_identify() {
  ignore_broken_pipes();  // a program that ends is an error of the write
  Result<std::unique_ptr<HidConnection>> opened = open(info_);
  if (!opened) return opened.error();
  auto& connection = static_cast<BridgeConnection&>(**opened);
  const OutReports start = kBridgeDriver.encode_start();
  connection.write(start.bytes[0].data(), start.sizes[0]);
  HidOpened result;
  int frames = 0;
  double last_sent_s = steady_now_s();
  const double patience_s = target_.kind == BridgeTarget::Kind::command ? kFirstFrameOfProgram_s : kFirstFrame_s;
  for (const double until_s = last_sent_s + patience_s; frames < kFramesToInspect && steady_now_s() < until_s;) {
    if (stop_requested() != 0) return Error{"interrupted"};
    std::uint8_t bytes[kLargestHidReport];
    const int size = connection.read(bytes, sizeof bytes);
    if (size < 0) {
      const std::string said = connection.garbage();
      return Error{info_.path + ": " + connection.end_words() + (said.empty() ? "" : ", after \"" + said + "\"") +
                   "; run it by itself to see why"};
    }
    // A board that was reset by the opening did not hear the first one.
    if (steady_now_s() - last_sent_s > 0.1) {
      connection.write(start.bytes[0].data(), start.sizes[0]);
      last_sent_s = steady_now_s();
    }
    DeviceReading reading;
    switch (size > 0 ? kBridgeDriver.decode(bytes, static_cast<std::size_t>(size), reading) : ReportVerdict::nothing) {
      case ReportVerdict::position:
        ++frames;
        result.measures_force = result.measures_force || reading.measured_N == reading.measured_N;
        break;
      case ReportVerdict::wrong_version:
        return Error{info_.path + ": speaks version " + std::to_string(reading.version) +
                     " of the bridge protocol, expected " + std::to_string(bridge::kVersion) +
                     "; update the device's program (devices/README.md#bridge)"};
      default:
        break;
    }
  }
  if (frames < kFramesToInspect) {
    const std::string said = connection.garbage();
    if (frames > 0) {
      return Error{info_.path + ": found " + std::to_string(frames) + " frames in " + fixed(patience_s, 0) +
                   " s, expected 100 to 10000 a second"};
    }
    if (!said.empty()) return Error{info_.path + ": found text, expected frames of 28 bytes: \"" + said + "\""};
    return Error{info_.path + ": no frame within " + fixed(patience_s, 0) +
                 " s; is the device's program running, at this baud rate?"};
  }
  result.info = info_;
  result.info.product = result.measures_force ? "measures force" : "measures no force";
  if (target_.remote) result.info.product += ", on a network: its delays count";
  result.driver = &kBridgeDriver;
  result.connection = std::move(*opened);
  return Result<HidOpened>(std::move(result));
}

}  // namespace palpate
