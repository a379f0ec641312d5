// A bus with one device, that of a `bridge:` target. Its reports are the frames in the byte stream.
// Thread guarantee: as DeviceBus.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/bridge/bridge_reports.h"
#include "devices/bridge/byte_stream.h"
#include "devices/link/device_bus.h"
#include "devices/link/device_link.h"

namespace palpate {

// A count is 1 nm, a unit 1 uN towards increasing positions. Decodes reports of BridgeReports.
extern const DeviceProtocol kBridgeProtocol;

class BridgeConnection final : public DeviceConnection {
 public:
  explicit BridgeConnection(std::unique_ptr<ByteStream> stream) : stream_(std::move(stream)) {}
  ~BridgeConnection() override;

  // Reads one report, see BridgeReports.
  int read(std::uint8_t* bytes, std::size_t capacity) noexcept override;
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept override;
  void stop_with(const OutReports& reports) noexcept override;

  // The first bytes that arrived before any frame, where they are text; else empty.
  std::string garbage() const;
  std::string end_words() noexcept { return stream_->end_words(); }

 private:
  std::unique_ptr<ByteStream> stream_;
  BridgeReports reports_;
  std::uint8_t bytes_[4096] = {};
  const std::uint8_t* next_ = bytes_;
  const std::uint8_t* end_ = bytes_;
  std::uint8_t first_[80] = {};  // first bytes, until there is a frame
  std::size_t first_count_ = 0;
  int stop_slot_ = -1;
};

class BridgeBus final : public DeviceBus {
 public:
  BridgeBus(BridgeTarget target, const std::string& text);

  std::vector<DeviceNode> list() override { return {info_}; }
  // Does not wait for a frame.
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode&) override;

  // Opens the device and waits for its first eight frames, up to 4 s (20 s for a program), because a board that resets
  // when its port is opened takes two seconds. Errors: those of ByteStream; no or too few frames, another version, text
  // instead of frames, a program that ended; interrupted.
  Result<OpenedDevice> open_and_identify();

 private:
  BridgeTarget target_;
  DeviceNode info_;
};

// Tests the watchdog of a device without force: it drives with force 0, then stops the frames, later only the
// heartbeat. Each time the status of the device must report the stop within 100 ms. Returns the measurements as text.
// Errors: those of open_and_identify; the requirement that was not met.
Result<std::string> test_bridge(const std::string& target);

}  // namespace palpate
