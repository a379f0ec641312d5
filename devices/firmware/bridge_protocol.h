// The frames of the bridge protocol, version 1 (devices/README.md#bridge), for host and firmware.
// C++11 with no library but stdint. All numbers are little-endian on every machine.
// Thread guarantee: pure functions and values, wait-free, never throw.
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
constexpr int32_t kNoForce = -2147483647 - 1;  // the device has no force sensor

// Status of the device, bits.
constexpr uint8_t kDriving = 1;
constexpr uint8_t kStopped = 2;  // its watchdog has stopped the motor; until a frame with a new heartbeat
constexpr uint8_t kMotorFault = 4;
constexpr uint8_t kSensorFault = 8;
constexpr uint8_t kGrip = 16;
constexpr uint8_t kKnownStatus = 31;

constexpr uint8_t kDrive = 1;  // flag of the host; without it the force is 0

struct FromDevice {
  uint32_t sequence;    // incremented by one per frame
  uint32_t time_us;     // of the sample, device clock, wraps
  int32_t position_nm;  // increases inward
  int32_t force_uN;     // measured, positive outward; or kNoForce
  uint8_t status;
  uint16_t confirmed;  // low half of the sequence of the last valid frame from the host
};

struct FromHost {
  uint32_t sequence;
  int32_t force_uN;    // on the tool, positive outward
  uint16_t heartbeat;  // incremented by one per tick of the haptics thread
  uint8_t flags;
};

// The bytes that all frames begin with.
inline void begin_frame(uint8_t* frame, uint8_t kind, uint32_t sequence) {
  frame[0] = 0x50;
  frame[1] = 0x42;
  frame[2] = kVersion;
  frame[3] = kind;
  wire::write32(frame + 4, sequence);
}

inline void encode(const FromDevice& in, uint8_t* frame) {
  begin_frame(frame, kFromDevice, in.sequence);
  wire::write32(frame + 8, in.time_us);
  wire::write32(frame + 12, static_cast<uint32_t>(in.position_nm));
  wire::write32(frame + 16, static_cast<uint32_t>(in.force_uN));
  frame[20] = in.status;
  frame[21] = 0;
  wire::write16(frame + 22, in.confirmed);
  wire::write32(frame + 24, wire::crc32(frame, 24));
}

inline void encode(const FromHost& out, uint8_t* frame) {
  begin_frame(frame, kFromHost, out.sequence);
  wire::write32(frame + 8, static_cast<uint32_t>(out.force_uN));
  wire::write16(frame + 12, out.heartbeat);
  frame[14] = out.flags;
  frame[15] = 0;
  wire::write32(frame + 16, wire::crc32(frame, 16));
}

// Decode frames of FrameFinder. False: an unknown bit is set.
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

// `skipped`: bytes that belong to no frame.
enum class Found : uint8_t { nothing, frame, other_version, skipped };

// Finds the frames of one kind in a byte stream. A frame begins with magic bytes, version and kind and ends with its
// checksum. After a false beginning the search continues at its second byte. Noise and a bit error in the version are
// no other version, because their checksum is wrong.
template <unsigned kBytes, uint8_t kKind>
class FrameFinder {
 public:
  Found add(uint8_t byte) {
    bytes_[count_++] = byte;
    Found found = Found::nothing;
    while (count_ > 0 && !may_be_frame()) {
      found = Found::skipped;
      --count_;
      for (unsigned i = 0; i < count_; ++i) bytes_[i] = bytes_[i + 1];
    }
    if (count_ < kBytes) return found;
    count_ = 0;
    return bytes_[2] == kVersion ? Found::frame : Found::other_version;
  }
  // The frame that `add` found, until its next call.
  const uint8_t* frame() const { return bytes_; }

 private:
  bool may_be_frame() const {
    return bytes_[0] == 0x50 && (count_ < 2 || bytes_[1] == 0x42) && (count_ < 4 || bytes_[3] == kKind) &&
           (count_ < kBytes || wire::crc32(bytes_, kBytes - 4) == wire::read32(bytes_ + kBytes - 4));
  }

  uint8_t bytes_[kBytes] = {};
  unsigned count_ = 0;
};

}  // namespace bridge
}  // namespace palpate
