// The reports of a device of the bridge in its stream of bytes: a frame, whose checksum is right; one byte where bytes
// between frames were none; the first four of a frame of another version. What is found here is not checked again.
// Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <cstdint>
#include <cstring>
#include <utility>

#include "devices/firmware/bridge_protocol.h"

namespace palpate {

class BridgeReports {
 public:
  // Takes bytes from `at` on until a report of at most kDeviceBytes is in `report`. Its size; 0: all were taken.
  int next(const std::uint8_t*& at, const std::uint8_t* end, std::uint8_t* report) noexcept {
    bool found = std::exchange(frame_waits_, false);
    while (!found && at != end) found = finder_.add(*at++);
    // What a stream begins with may be the rest of a frame.
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
  std::uint32_t skipped_ = 0;  // of which a report was made
  bool any_frame_ = false;
  bool frame_waits_ = false;  // behind a gap that was reported first
};

}  // namespace palpate
