// One reading of a device's position, for all transports.
// Thread guarantee: values.
#pragma once

#include <cstdint>
#include <limits>

namespace palpate {

// The result of decoding one report.
enum class ReportVerdict : std::uint8_t {
  position,       // a reading with the position
  nothing,        // valid, but without a position
  corrupt,        // length, checksum or content is wrong
  wrong_version,  // another version of the protocol, see DeviceReading::version
};

struct DeviceReading {
  std::int32_t counts = 0;
  // Of a timed protocol.
  std::uint32_t sequence = 0;
  std::uint32_t time_us = 0;
  std::uint32_t confirmed = 0;  // sequence of the last command that the device obeyed
  std::uint8_t version = 0;
  double measured_N = std::numeric_limits<double>::quiet_NaN();  // of a force sensor; NaN: none
  bool grip = false;                                             // the switch on the handle is held
  bool driving = false;                                          // the motor is on
  bool stopped = false;    // the device's watchdog has stopped the motor because the host was silent
  bool own_fault = false;  // the device reports a fault
};

}  // namespace palpate
