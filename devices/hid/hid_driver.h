// What the program knows of one HID protocol, as data and pure functions: bytes
// in, a reading out; a command in, bytes out. Each protocol is one file below
// devices/hid/protocol/ and one line of the table in hid_drivers.h; everything else
// iterates over that table. A driver is known by its address.
//
// Thread guarantee: pure functions, any thread; wait-free, never throw, read
// nothing beyond `size`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "devices/stream/device_reading.h"

namespace palpate {

inline constexpr std::size_t kLargestHidReport = 64;

// One node of the bus.
struct HidDeviceInfo {
  std::string path;  // of the node; empty: there is none
  std::string product;
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint16_t usage_page = 0;
  std::uint16_t usage = 0;
};

struct HidCommand {
  std::uint32_t sequence = 0;
  std::uint16_t heartbeat = 0;
  bool drive = false;
  double units = 0.0;  // what one is, the driver says
};

// Reports to write one after the other, as hid_write wants them: the report id
// first, 0 for none.
struct OutReports {
  std::array<std::array<std::uint8_t, kLargestHidReport + 1>, 4> bytes{};
  std::array<std::size_t, 4> sizes{};
  std::size_t count = 0;
};

// What each driver was tried on, in words.
inline constexpr const char* kHidTried = "on real hardware: no; on an emulated device: yes";

struct HidDriver {
  const char* name;         // of its calibration file and in messages
  const char* description;  // in words
  bool renders_force;
  // Counts are nm from the surface on, units uN: nothing is zeroed. Reports have a sequence,
  // a time and a confirmation, and come at any rate that they like; else arrival is all
  // there is.
  bool knows_position = false;

  bool (*matches)(const HidDeviceInfo& info) noexcept;
  // `bytes` as read from hidraw, a report id included where there is one; `reading`
  // comes in its default state.
  ReportVerdict (*decode)(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept;
  // Once after opening.
  OutReports (*encode_start)() noexcept;
  // In every cycle; also asks for the position where the device does not send it
  // by itself.
  OutReports (*encode_command)(const HidCommand& command) noexcept;
  // Takes the force away, whatever was sent before.
  OutReports (*encode_stop)() noexcept;
};

}  // namespace palpate
