// What the program knows of one protocol, as data and pure functions: bytes in, a reading out; a command in, bytes out.
// A protocol is one file in devices/hid or devices/bridge; the link layer names none of them.
//
// Thread guarantee: pure functions, any thread; wait-free, never throw, read
// nothing beyond `size`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/link/device_reading.h"

namespace palpate {

inline constexpr std::size_t kLargestReport = 64;

// One node of the bus.
struct DeviceNode {
  std::string path;  // of the node; empty: there is none
  std::string product;
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint16_t usage_page = 0;
  std::uint16_t usage = 0;
};

struct DeviceCommand {
  std::uint32_t sequence = 0;
  std::uint16_t heartbeat = 0;
  bool drive = false;
  double units = 0.0;  // what one is, the protocol says
};

// Reports to write one after the other, as the connection wants them: of HID the report id first, 0 for none.
struct OutReports {
  std::array<std::array<std::uint8_t, kLargestReport + 1>, 4> bytes{};
  std::array<std::size_t, 4> sizes{};
  std::size_t count = 0;
};

// What each protocol was tried on, in words.
inline constexpr const char* kTried = "on real hardware: no; on an emulated device: yes";

struct DeviceProtocol {
  const char* name;         // of its calibration file and in messages
  const char* description;  // in words
  // What it can do; each alone.
  bool renders_force = false;
  bool absolute = false;  // counts are nm from the surface on, units uN: nothing is zeroed
  bool timed = false;     // reports have a sequence and a time and come at any rate; else arrival is all there is
  bool confirms = false;  // reports say which command was obeyed last

  bool (*matches)(const DeviceNode& info) noexcept;
  // `bytes` as the connection read them, a report id included where there is one; `reading` comes in its default state.
  ReportVerdict (*decode)(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept;
  // Once after opening.
  OutReports (*encode_start)() noexcept;
  // In every cycle; also asks for the position where the device does not send it
  // by itself.
  OutReports (*encode_command)(const DeviceCommand& command) noexcept;
  // Takes the force away, whatever was sent before.
  OutReports (*encode_stop)() noexcept;
};

// None of them null.
using DeviceProtocols = std::vector<const DeviceProtocol*>;

}  // namespace palpate
