// The frames between Palpate and any device that speaks `bridge:`, version 1. Both ends
// include this file; devices/README.md#bridge has the byte offsets.
//
// C++11 without a library beyond stdint. All numbers are little-endian whatever the
// machine. Thread guarantee: pure functions and values, wait-free, never throw.
#pragma once

#ifndef ARDUINO  // a sketch includes the files of its folder itself
#include "devices/firmware/wire.h"
#endif

namespace palpate {
namespace bridge {

constexpr uint8_t kVersion = 1;
constexpr uint8_t kFromDevice = 0x49;  // 'I'
constexpr uint8_t kFromHost = 0x4F;    // 'O'
constexpr unsigned kDeviceBytes = 28;
constexpr unsigned kHostBytes = 20;
constexpr int32_t kNoForce = -2147483647 - 1;  // the device measures none

// Status of the device, bits.
constexpr uint8_t kDriving = 1;
constexpr uint8_t kStopped = 2;  // by its watchdog; until a valid frame comes
constexpr uint8_t kMotorFault = 4;
constexpr uint8_t kSensorFault = 8;
constexpr uint8_t kGrip = 16;
constexpr uint8_t kKnownStatus = 31;

constexpr uint8_t kDrive = 1;  // flag of the host; without it the force counts as 0

struct FromDevice {
  uint32_t sequence;    // one more for each frame
  uint32_t time_us;     // of the sample, device clock, wraps
  int32_t position_nm;  // grows inward
  int32_t force_uN;     // measured, positive outward; kNoForce
  uint8_t status;
  uint16_t confirmed;  // low half of the sequence of the last valid frame from the host
};

struct FromHost {
  uint32_t sequence;
  int32_t force_uN;    // on the tool, positive pushes it out
  uint16_t heartbeat;  // one more for each tick of the haptics thread
  uint8_t flags;
};

namespace detail {

inline void begin(uint8_t* frame, uint8_t kind, uint32_t sequence) {
  frame[0] = 0x50;
  frame[1] = 0x42;
  frame[2] = kVersion;
  frame[3] = kind;
  wire::write32(frame + 4, sequence);
}

}  // namespace detail

inline void encode(const FromDevice& in, uint8_t* frame) {
  detail::begin(frame, kFromDevice, in.sequence);
  wire::write32(frame + 8, in.time_us);
  wire::write32(frame + 12, static_cast<uint32_t>(in.position_nm));
  wire::write32(frame + 16, static_cast<uint32_t>(in.force_uN));
  frame[20] = in.status;
  frame[21] = 0;
  wire::write16(frame + 22, in.confirmed);
  wire::write32(frame + 24, wire::crc32(frame, 24));
}

inline void encode(const FromHost& out, uint8_t* frame) {
  detail::begin(frame, kFromHost, out.sequence);
  wire::write32(frame + 8, static_cast<uint32_t>(out.force_uN));
  wire::write16(frame + 12, out.heartbeat);
  frame[14] = out.flags;
  frame[15] = 0;
  wire::write32(frame + 16, wire::crc32(frame, 16));
}

// Of frames that FrameFinder found. False: a bit that is not known is set.
inline bool decode(const uint8_t* frame, FromDevice& in) {
  in.sequence = wire::read32(frame + 4);
  in.time_us = wire::read32(frame + 8);
  in.position_nm = static_cast<int32_t>(wire::read32(frame + 12));
  in.force_uN = static_cast<int32_t>(wire::read32(frame + 16));
  in.status = frame[20];
  in.confirmed = wire::read16(frame + 22);
  return (in.status & ~kKnownStatus) == 0 && frame[21] == 0;
}

inline bool decode(const uint8_t* frame, FromHost& out) {
  out.sequence = wire::read32(frame + 4);
  out.force_uN = static_cast<int32_t>(wire::read32(frame + 8));
  out.heartbeat = wire::read16(frame + 12);
  out.flags = frame[14];
  return (out.flags & ~kDrive) == 0 && frame[15] == 0;
}

// Finds the frames of one kind in a stream of bytes, whatever lies between them: a frame
// is what begins with the magic, the version and the kind and ends with its checksum. No
// byte of a false beginning is lost for the next one.
template <unsigned kBytes, uint8_t kKind>
class FrameFinder {
 public:
  // True: `frame` holds the next one, until the next call.
  bool add(uint8_t byte) {
    bytes_[count_++] = byte;
    while (count_ > 0) {
      if (!may_be_frame()) {
        drop_first();
      } else if (count_ < kBytes) {
        return false;
      } else if (wire::crc32(bytes_, kBytes - 4) == wire::read32(bytes_ + kBytes - 4)) {
        count_ = 0;
        return true;
      } else {
        drop_first();
      }
    }
    return false;
  }
  const uint8_t* frame() const { return bytes_; }
  uint32_t skipped() const { return skipped_; }             // bytes that were in no frame, wraps
  uint8_t other_version() const { return other_version_; }  // seen last, 0: none

 private:
  // The kind comes behind the version, which is judged only with it.
  bool may_be_frame() {
    if (bytes_[0] != 0x50 || (count_ > 1 && bytes_[1] != 0x42) || (count_ > 3 && bytes_[3] != kKind)) return false;
    if (count_ < 4 || bytes_[2] == kVersion) return true;
    other_version_ = bytes_[2];
    return false;
  }
  void drop_first() {
    ++skipped_;
    --count_;
    for (unsigned i = 0; i < count_; ++i) bytes_[i] = bytes_[i + 1];
  }

  uint8_t bytes_[kBytes] = {};
  unsigned count_ = 0;
  uint32_t skipped_ = 0;
  uint8_t other_version_ = 0;
};

}  // namespace bridge
}  // namespace palpate
