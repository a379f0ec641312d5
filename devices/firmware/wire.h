// Common parts of firmware and HID reports: little-endian numbers, a checksum, and the watchdog for a silent host.
// C++11 with no library but stdint, so that it compiles for an Arduino.
// Thread guarantee: pure functions and values, wait-free, never throw.
#pragma once

#include <stdint.h>

namespace palpate {
namespace wire {

// CRC-32 of IEEE 802.3: reflected polynomial 0xEDB88320, initial value and result inverted. It processes half a byte at
// a time: the table fits an 8-bit board, and it is four times as fast as bit by bit.
inline uint32_t crc32(const uint8_t* bytes, unsigned count) {
  static const uint32_t kNibbles[16] = {0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
                                        0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
                                        0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
  uint32_t crc = 0xFFFFFFFFu;
  for (unsigned i = 0; i < count; ++i) {
    crc = (crc >> 4) ^ kNibbles[(crc ^ bytes[i]) & 15u];
    crc = (crc >> 4) ^ kNibbles[(crc ^ (bytes[i] >> 4)) & 15u];
  }
  return ~crc;
}

inline uint16_t read16(const uint8_t* at) { return static_cast<uint16_t>(at[0] | (at[1] << 8)); }
inline uint32_t read32(const uint8_t* at) {
  return static_cast<uint32_t>(read16(at)) | (static_cast<uint32_t>(read16(at + 2)) << 16);
}
inline void write16(uint8_t* at, uint16_t value) {
  at[0] = static_cast<uint8_t>(value & 0xFF);
  at[1] = static_cast<uint8_t>(value >> 8);
}
inline void write32(uint8_t* at, uint32_t value) {
  write16(at, static_cast<uint16_t>(value & 0xFFFF));
  write16(at + 2, static_cast<uint16_t>(value >> 16));
}

// Whether `a` comes after `b` on a counter that wraps.
inline bool later(uint32_t a, uint32_t b) { return static_cast<int32_t>(a - b) > 0; }

// A board's watchdog: decides whether a command may be obeyed, and whether the host is silent. A command with `drive`
// is obeyed only when its sequence is later than the last one; a command without it is always obeyed, so that stopping
// works and a host may restart.
class HostWatch {
 public:
  // The host is silent after this time without a valid command or without a new heartbeat.
  static constexpr uint32_t kTimeout_us = 50000;

  explicit HostWatch(uint32_t now_us) : valid_us_(now_us), beat_us_(now_us) {}

  // Call it for each valid command. False: the command is old and must not be obeyed.
  bool accept(uint32_t now_us, uint32_t sequence, uint16_t heartbeat, bool drive) {
    if (drive && !any_sequence_ && !later(sequence, sequence_)) return false;
    if (!any_command_ || heartbeat != heartbeat_) beat_us_ = now_us;
    heartbeat_ = heartbeat;
    sequence_ = sequence;
    any_command_ = true;
    any_sequence_ = false;
    valid_us_ = now_us;
    return true;
  }

  bool host_timed_out(uint32_t now_us) const {
    return now_us - valid_us_ >= kTimeout_us || now_us - beat_us_ >= kTimeout_us;
  }
  uint32_t sequence() const { return sequence_; }    // of the last accepted command
  bool any_command() const { return any_command_; }  // whether any command was accepted
  // Accepts any sequence next, for a restarted host. A new heartbeat is still required.
  void accept_any_sequence() { any_sequence_ = true; }

 private:
  uint32_t valid_us_, beat_us_;
  uint32_t sequence_ = 0;
  uint16_t heartbeat_ = 0;
  bool any_command_ = false;
  bool any_sequence_ = true;
};

}  // namespace wire
}  // namespace palpate
