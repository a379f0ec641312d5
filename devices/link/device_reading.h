// One reading of a device's position, whatever the transport brought it by.
// Thread guarantee: values.
#pragma once

#include <cstdint>
#include <limits>

namespace palpate {

// What a decoder says of one report.
enum class ReportVerdict : std::uint8_t {
  position,       // a reading with the position
  nothing,        // valid, but not about the position
  corrupt,        // length, checksum or content is wrong
  wrong_version,  // of the protocol; DeviceReading::version has the one found
};

struct DeviceReading {
  std::int32_t counts = 0;
  // Of a device that numbers and times its reports.
  std::uint32_t sequence = 0;
  std::uint32_t time_us = 0;
  std::uint32_t confirmed = 0;  // of the host's command that it obeyed last
  std::uint8_t version = 0;
  double measured_N = std::numeric_limits<double>::quiet_NaN();  // of a force sensor; NaN: none
  bool grip = false;
  bool driving = false;    // the device says that its motor is on
  bool stopped = false;    // by the device's own watchdog: it did not hear the host
  bool own_fault = false;  // the device says that it has one
};

}  // namespace palpate
