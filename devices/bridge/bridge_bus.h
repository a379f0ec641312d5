// The device behind one `bridge:` target as a bus with that one device: every report that
// it reads is a frame, found in the stream of bytes.
// Thread guarantee: as HidBus.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/bridge/byte_stream.h"
#include "devices/firmware/bridge_protocol.h"
#include "devices/hid/hid_bus.h"
#include "devices/hid/hid_link.h"

namespace palpate {

class BridgeConnection final : public HidConnection {
 public:
  explicit BridgeConnection(std::unique_ptr<ByteStream> stream) : stream_(std::move(stream)) {}
  ~BridgeConnection() override;

  // A frame; one byte where bytes between frames were none; four of another version's.
  int read(std::uint8_t* bytes, std::size_t capacity) noexcept override;
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept override;
  void stop_with(const OutReports& reports) noexcept override;

  // Before the first frame: what came instead, as text; why the stream ended.
  std::string garbage() const;
  std::string end_words() noexcept { return stream_->end_words(); }

 private:
  std::unique_ptr<ByteStream> stream_;
  bridge::FrameFinder<bridge::kDeviceBytes, bridge::kFromDevice> finder_;
  std::uint8_t bytes_[4096] = {};
  std::size_t next_ = 0, count_ = 0;
  std::uint8_t first_[80] = {};  // bytes, until there was a frame
  std::size_t first_count_ = 0;
  std::uint32_t skipped_ = 0;  // told of
  bool any_frame_ = false;
  bool frame_waits_ = false;  // behind a gap that was told of first
  int stop_slot_ = -1;
};

class BridgeBus final : public HidBus {
 public:
  BridgeBus(BridgeTarget target, const std::string& text);

  std::vector<HidDeviceInfo> list() override { return {info_}; }
  // Does not wait for a frame.
  Result<std::unique_ptr<HidConnection>> open(const HidDeviceInfo&) override;

  // The first time: waits for the first frames, for a board that resets when its port is
  // opened takes two seconds. Errors: those of ByteStream; silence, another version, text
  // or noise instead of frames, a program that ended.
  Result<HidOpened> open_and_identify();

 private:
  BridgeTarget target_;
  HidDeviceInfo info_;
};

// Moves nothing: drives with no force, falls silent, and lets the device show by its
// status that its watchdog stopped it, for frames that do not come and for a heartbeat
// that stands still. Text with what was measured; errors: what it did not show.
Result<std::string> test_bridge(const std::string& target);

}  // namespace palpate
