// The device behind one `bridge:` target as a bus with that one device: every report that
// it reads is a frame, found in the stream of bytes.
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

// A count is 1 nm, a unit 1 uN towards growing positions. Of reports that BridgeReports found.
extern const DeviceProtocol kBridgeProtocol;

class BridgeConnection final : public DeviceConnection {
 public:
  explicit BridgeConnection(std::unique_ptr<ByteStream> stream) : stream_(std::move(stream)) {}
  ~BridgeConnection() override;

  // Reports as BridgeReports finds them.
  int read(std::uint8_t* bytes, std::size_t capacity) noexcept override;
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept override;
  void stop_with(const OutReports& reports) noexcept override;

  // Before the first frame: what came instead, as text; why the stream ended.
  std::string garbage() const;
  std::string end_words() noexcept { return stream_->end_words(); }

 private:
  std::unique_ptr<ByteStream> stream_;
  BridgeReports reports_;
  std::uint8_t bytes_[4096] = {};
  const std::uint8_t* next_ = bytes_;
  const std::uint8_t* end_ = bytes_;
  std::uint8_t first_[80] = {};  // bytes, until there was a frame
  std::size_t first_count_ = 0;
  int stop_slot_ = -1;
};

class BridgeBus final : public DeviceBus {
 public:
  BridgeBus(BridgeTarget target, const std::string& text);

  std::vector<DeviceNode> list() override { return {info_}; }
  // Does not wait for a frame.
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode&) override;

  // The first time: waits for the first frames, for a board that resets when its port is
  // opened takes two seconds. Errors: those of ByteStream; silence, another version, text
  // or noise instead of frames, a program that ended.
  Result<OpenedDevice> open_and_identify();

 private:
  BridgeTarget target_;
  DeviceNode info_;
};

// Moves nothing: drives with no force, falls silent, and lets the device show by its
// status that its watchdog stopped it, for frames that do not come and for a heartbeat
// that stands still. Text with what was measured; errors: what it did not show.
Result<std::string> test_bridge(const std::string& target);

}  // namespace palpate
