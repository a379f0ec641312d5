// The reports of every HID device that the program knows, as pure functions:
// bytes in, a reading out; a command in, bytes out.
//
//   paddle       our own protocol, devices/hid/paddle_protocol.md
//   polhem       Polhem / WoodenHaptics: int16 encoders a-f and int16 info in;
//                int16 mA a-c, int16 command, three int16 attributes out (14
//                bytes, little-endian); axis a is used
//   openffboard  vendor report 0xA1, 25 bytes: type u8, class u16, instance u8,
//                command u32, data u64, address u64; firmware in its mode
//                "HID Gamepad (Ext FFB)": position of axis 0, one constant force
//   spacemouse   3Dconnexion: report 1 begins with three int16 translations;
//                z is used, positive when pushed down; no force
//
// Thread guarantee: pure functions, any thread; wait-free, never throw, read
// nothing beyond `size`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate {

enum class HidKind : std::uint8_t { paddle, polhem, openffboard, spacemouse };
inline constexpr std::array<HidKind, 4> kHidKinds = {HidKind::paddle, HidKind::polhem, HidKind::openffboard,
                                                     HidKind::spacemouse};

// As in the names of the calibration files and in messages.
const char* hid_kind_name(HidKind kind) noexcept;
// Without one, its reports say nothing of order, or of time.
constexpr bool has_sequence(HidKind kind) noexcept { return kind == HidKind::paddle; }
constexpr bool pushes(HidKind kind) noexcept { return kind != HidKind::spacemouse; }

inline constexpr std::size_t kLargestHidReport = 64;

enum class ReportVerdict : std::uint8_t {
  position,       // a reading with the position
  nothing,        // valid, but not about the position
  corrupt,        // length, checksum or content is wrong
  wrong_version,  // of the paddle protocol
};

struct HidReading {
  std::int32_t counts = 0;
  // Of the paddle alone.
  std::uint32_t sequence = 0;
  std::uint32_t time_us = 0;
  std::uint32_t confirmed = 0;  // of the host's report that it obeyed last
  std::uint16_t boot = 0;
  bool grip = false;
  bool own_fault = false;  // the device says that it has one
};

// `bytes` as read from hidraw, a report id included where there is one.
ReportVerdict decode_report(HidKind kind, const std::uint8_t* bytes, std::size_t size,
                            HidReading& reading) noexcept;

// Width of the counter behind `counts`; it wraps.
constexpr int count_bits(HidKind kind) noexcept { return kind == HidKind::polhem ? 16 : 32; }

struct HidCommand {
  std::uint32_t sequence = 0;
  std::uint16_t heartbeat = 0;
  bool drive = false;
  double units = 0.0;  // mA, or 1/32767 of full force of an OpenFFBoard; clamped to what 16 bits hold
};

// Reports to write one after the other, as hid_write wants them: the report id
// first, 0 for none.
struct OutReports {
  std::array<std::array<std::uint8_t, kLargestHidReport + 1>, 4> bytes{};
  std::array<std::size_t, 4> sizes{};
  std::size_t count = 0;
};

// Once after opening.
OutReports encode_start(HidKind kind) noexcept;
// In every cycle; also asks for the position where the device does not send it
// by itself.
OutReports encode_command(HidKind kind, const HidCommand& command) noexcept;
// Takes the force away, whatever was sent before.
OutReports encode_stop(HidKind kind) noexcept;

}  // namespace palpate
