#include "devices/bridge/bridge_bus.h"

#include <cctype>
#include <cstdio>
#include <utility>

#include "devices/link/device_stop.h"
#include "engine/base/signals.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

constexpr int kRead_ms = 50;  // short, so that the reader thread ends soon after it is stopped
// A board that resets takes two seconds; a program with an SDK may search for its device first.
constexpr double kFirstFrame_s = 4.0, kFirstFrameOfProgram_s = 20.0;
constexpr int kFramesToInspect = 8;

}  // namespace

BridgeConnection::~BridgeConnection() { unregister_device_stop(stop_slot_); }

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
