// A bus with one device, that of a `bridge:` target. Its reports are the frames in the byte stream.
// Thread guarantee: as DeviceBus.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "devices/firmware/bridge_protocol.h"
#include "devices/link/device_link.h"

namespace palpate {

// A count is 1 nm. A unit of force is 1 uN and positive towards increasing positions. Decodes reports of BridgeReports.
extern const DeviceProtocol kBridgeProtocol;

// Divides the byte stream into reports: a frame with a valid checksum; one byte for a gap, which is a run of bytes that
// belong to no frame; the first four bytes of a frame of another version with a valid checksum. One thread; wait-free,
// never throws.
class BridgeReports {
 public:
  // Consumes bytes from `at` until `report` has a report of at most kDeviceBytes. Returns its size; 0: all bytes were
  // consumed without one.
  int next(const std::uint8_t*& at, const std::uint8_t* end, std::uint8_t* report) noexcept {
    bool found = std::exchange(frame_waits_, false);
    while (!found && at != end) found = finder_.add(*at++);
    // The stream may begin within a frame, so bytes before the first frame are no gap.
    const bool gap = any_frame_ && finder_.skipped() != skipped_;
    skipped_ = finder_.skipped();
    any_frame_ = any_frame_ || found;
    if (!found && finder_.other_version() != 0) {
      const std::uint8_t header[4] = {0x50, 0x42, finder_.other_version(), bridge::kFromDevice};
      std::memcpy(report, header, sizeof header);
      finder_ = {};
      skipped_ = 0;
      return sizeof header;
    }
    if (gap) {
      frame_waits_ = found;
      report[0] = 0;
      return 1;
    }
    if (!found) return 0;
    std::memcpy(report, finder_.frame(), bridge::kDeviceBytes);
    return static_cast<int>(bridge::kDeviceBytes);
  }
  bool any_frame() const noexcept { return any_frame_; }

 private:
  bridge::FrameFinder<bridge::kDeviceBytes, bridge::kFromDevice> finder_;
  std::uint32_t skipped_ = 0;  // skipped bytes that were reported
  bool any_frame_ = false;
  bool frame_waits_ = false;  // a frame follows the gap that was reported
};

class BridgeBus final : public DeviceBus {
 public:
  // `target`: see ByteStream::open.
  explicit BridgeBus(std::string target);

  std::vector<DeviceNode> list() override { return {info_}; }
  // Does not wait for a frame.
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode&) override;

  // Opens the device and measures the rate of its first frames. Waits for them up to 4 s (20 s for a program), because
  // a board that resets when its port is opened takes two seconds. Errors: those of ByteStream; no or too few frames,
  // fewer than 100 a second, another version, a program that ended; interrupted.
  Result<OpenedDevice> open_and_identify();

 private:
  std::string target_;
  DeviceNode info_;
};

// Tests the watchdog of a device without force: it drives with force 0, then stops the frames, later only the
// heartbeat. Each time the status of the device must report the stop within 100 ms. Returns the measurements as text.
// Errors: those of open_and_identify; the requirement that was not met.
Result<std::string> test_bridge(const std::string& target);

}  // namespace palpate
