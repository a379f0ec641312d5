// Common parts of firmware and HID reports: little-endian numbers and a checksum.
// C++11 with no library but stdint, so that it compiles for an Arduino.
// Thread guarantee: pure functions, wait-free, never throw.
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

}  // namespace wire
}  // namespace palpate
