// Divides the byte stream of a bridge device into reports: a frame with a valid checksum; a report of one byte where
// bytes between frames belong to no frame; the first four bytes of a frame of another version.
// Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <cstdint>
#include <cstring>
#include <utility>

#include "devices/firmware/bridge_protocol.h"

namespace palpate {

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

}  // namespace palpate
