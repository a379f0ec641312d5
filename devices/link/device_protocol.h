// A device protocol: its properties, and pure functions that decode reports and encode commands; and the calibration of
// one kind of device. Each protocol is one file in devices/hid or devices/bridge; the link layer does not depend on any
// of them.
// Thread guarantee: pure functions, any thread; wait-free, never throw, read nothing beyond `size`. Calibrations: slow
// side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "engine/base/result.h"
#include "engine/live/device.h"

namespace palpate {

inline constexpr std::size_t kLargestReport = 64;

struct DeviceNode {
  std::string path;  // empty: there is no node
  std::string product;
  std::uint16_t vendor_id = 0, product_id = 0, usage_page = 0, usage = 0;
};

enum class ReportVerdict : std::uint8_t {
  position,       // a reading with the position
  nothing,        // valid, but without a position
  corrupt,        // length, checksum or content is wrong
  wrong_version,  // another version of the protocol, see DeviceReading::version
};

struct DeviceReading {
  std::int32_t counts = 0;
  // `sequence` and `time_us`: of a `timed` protocol; `confirmed`: of one that `confirms`.
  std::uint32_t sequence = 0, time_us = 0;
  std::uint32_t confirmed = 0;  // sequence of the last command that the device obeyed
  std::uint8_t version = 0;
  double measured_N = std::numeric_limits<double>::quiet_NaN();  // of a force sensor; NaN: none
  bool grip = false;                                             // the switch on the handle is held
  bool driving = false;                                          // the motor is on
  bool stopped = false;    // the device's watchdog has stopped the motor because the host was silent
  bool own_fault = false;  // the device reports a fault
};

struct DeviceCommand {
  std::uint32_t sequence = 0;
  std::uint16_t heartbeat = 0;  // changes with each tick of the haptics thread
  bool drive = false;           // false: no force
  double units = 0.0;           // force, see DeviceCalibration::force_N_per_unit
};

// Reports to write one after the other. Those of HID begin with the report id, 0 for none.
struct OutReports {
  std::array<std::array<std::uint8_t, kLargestReport + 1>, 4> bytes{};
  std::array<std::size_t, 4> sizes{};
  std::size_t count = 0;
};

// What all protocols were tested on.
inline constexpr const char* kTestedOn = "on real hardware: no; on an emulated device: yes";

struct DeviceProtocol {
  const char* name;         // in messages; name of its calibration file
  const char* description;  // a few words
  // Independent capabilities.
  bool renders_force = false;
  bool absolute = false;  // counts are nm from the surface, units are uN; no zeroing is necessary
  bool timed = false;     // reports have sequence and time, and any rate; else the time of arrival is used
  bool confirms = false;  // reports have the sequence of the last command that was obeyed

  bool (*matches)(const DeviceNode& info) noexcept;
  // `bytes`: a report as the connection read it, with a report id where there is one; `reading`: default-constructed.
  ReportVerdict (*decode)(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept;
  // The reports to send once after opening; a command, which also requests the position if the device does not send it
  // unasked; the removal of the force. The default writes nothing.
  OutReports (*encode_start)() noexcept = []() noexcept { return OutReports{}; };
  OutReports (*encode_command)(const DeviceCommand&) noexcept = [](const DeviceCommand&) noexcept {
    return OutReports{};
  };
  OutReports (*encode_stop)() noexcept = encode_start;
};

// Calibration and limits of one kind of device: the JSON file of its protocol in assets/devices/.
struct DeviceCalibration {
  const DeviceProtocol* protocol = nullptr;  // not null once the file is read
  double counts_per_metre = 0.0;             // > 0
  double encoder_step_m = 0.0;               // 0: one count
  // 1: counts increase into the block, -1: out of it. A positive command always drives the counts up, so a force out of
  // the block is a command with the sign of -direction.
  double direction = 1.0;
  // Position of the tool while it is zeroed, or of count 0 of an absolute device; negative: outside of the block.
  double rest_position_m = 0.0;
  // The following apply only to devices that render force.
  double fastest_m_per_s = 0.0;   // a faster motion is a fault of the encoder (a jump)
  double force_N_per_unit = 0.0;  // see DeviceCommand::units
  double stuck_after_s = 0.0;     // the encoder is stuck when no count changes for this time under force
  ForceLimits limits;             // stop_s keeps its default
};

// Reads `folder`/<name of the protocol>.json, whose "kind" must be that name. Errors: the file cannot be read; not
// JSON; a value that is missing, unknown or out of range, with path:line:column, found, expected.
Result<DeviceCalibration> read_calibration(const std::string& folder, const DeviceProtocol& protocol);

}  // namespace palpate
