// The reports between a haptic paddle and its host, version 1. Both ends include
// this file; devices/hid/paddle_protocol.md is the page with the byte offsets.
//
// C++11 without a library beyond stdint, so that an Arduino compiles it. All
// numbers are little-endian whatever the machine.
// Thread guarantee: pure functions, wait-free, never throw.
#pragma once

#ifndef ARDUINO  // a sketch includes the files of its folder itself
#include "devices/firmware/paddle/wire.h"
#endif

namespace palpate {
namespace paddle {

constexpr uint8_t kMagic = 0x50;  // 'P'
constexpr uint8_t kVersion = 1;
constexpr uint8_t kFromDevice = 0x49;  // 'I'
constexpr uint8_t kFromHost = 0x4F;    // 'O'
constexpr unsigned kReportBytes = 64;
constexpr unsigned kChecksumAt = 60;

constexpr uint32_t kReportPeriod_us = 1000;

// Status of the device, bits.
constexpr uint8_t kDriving = 1;     // the motor is on
constexpr uint8_t kStopped = 2;     // by the watchdog; until a valid report comes
constexpr uint8_t kMotorFault = 4;  // over-current or over-temperature
constexpr uint8_t kEncoderFault = 8;
constexpr uint8_t kGrip = 16;  // the switch on the handle is held
constexpr uint8_t kKnownStatus = 31;

// Flags of the host, bits.
constexpr uint8_t kDrive = 1;  // without it the current counts as 0

struct FromDevice {
  uint8_t status;
  uint32_t sequence;   // one more for each report
  uint32_t time_us;    // since the start, wraps
  int32_t counts;      // of the encoder
  int16_t current_mA;  // that the motor gets
  uint16_t boot;       // another number after each start of the firmware
  uint32_t confirmed;  // sequence of the last valid report from the host
  uint16_t rejected;   // reports from the host that were not valid, wraps
};

struct FromHost {
  uint8_t flags;
  uint32_t sequence;   // one more for each report; a report with no drive is obeyed whatever it says
  int16_t current_mA;  // positive: towards growing counts
  uint16_t heartbeat;  // one more for each tick of the host's haptics thread, wraps
};

enum Verdict : uint8_t { kGood, kBadMagic, kBadVersion, kBadKind, kBadChecksum, kBadContent };

using wire::crc32;
using wire::read16;
using wire::read32;
using wire::write16;
using wire::write32;

namespace detail {

inline void begin(uint8_t* report, uint8_t kind, uint8_t bits, uint32_t sequence) {
  for (unsigned i = 0; i < kReportBytes; ++i) report[i] = 0;
  report[0] = kMagic;
  report[1] = kVersion;
  report[2] = kind;
  report[3] = bits;
  write32(report + 4, sequence);
}

inline Verdict check(const uint8_t* report, uint8_t kind) {
  if (report[0] != kMagic) return kBadMagic;
  if (report[1] != kVersion) return kBadVersion;
  if (report[2] != kind) return kBadKind;
  return crc32(report, kChecksumAt) == read32(report + kChecksumAt) ? kGood : kBadChecksum;
}

}  // namespace detail

// `report`: kReportBytes.
inline void encode(const FromDevice& in, uint8_t* report) {
  detail::begin(report, kFromDevice, in.status, in.sequence);
  write32(report + 8, in.time_us);
  write32(report + 12, static_cast<uint32_t>(in.counts));
  write16(report + 16, static_cast<uint16_t>(in.current_mA));
  write16(report + 18, in.boot);
  write32(report + 20, in.confirmed);
  write16(report + 24, in.rejected);
  write32(report + kChecksumAt, crc32(report, kChecksumAt));
}

inline Verdict decode(const uint8_t* report, FromDevice& in) {
  const Verdict verdict = detail::check(report, kFromDevice);
  if (verdict != kGood) return verdict;
  in.status = report[3];
  in.sequence = read32(report + 4);
  in.time_us = read32(report + 8);
  in.counts = static_cast<int32_t>(read32(report + 12));
  in.current_mA = static_cast<int16_t>(read16(report + 16));
  in.boot = read16(report + 18);
  in.confirmed = read32(report + 20);
  in.rejected = read16(report + 24);
  return (in.status & ~kKnownStatus) == 0 ? kGood : kBadContent;
}

inline void encode(const FromHost& out, uint8_t* report) {
  detail::begin(report, kFromHost, out.flags, out.sequence);
  write16(report + 8, static_cast<uint16_t>(out.current_mA));
  write16(report + 10, out.heartbeat);
  write32(report + kChecksumAt, crc32(report, kChecksumAt));
}

inline Verdict decode(const uint8_t* report, FromHost& out) {
  const Verdict verdict = detail::check(report, kFromHost);
  if (verdict != kGood) return verdict;
  out.flags = report[3];
  out.sequence = read32(report + 4);
  out.current_mA = static_cast<int16_t>(read16(report + 8));
  out.heartbeat = read16(report + 10);
  return (out.flags & ~kDrive) == 0 ? kGood : kBadContent;
}

}  // namespace paddle
}  // namespace palpate
