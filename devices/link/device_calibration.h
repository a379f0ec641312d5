// What one kind of device measures and bears: one JSON file per protocol, named
// after it, in assets/devices/.
//
// Thread guarantee: slow side only.
#pragma once

#include <string>
#include <string_view>

#include "devices/link/device_protocol.h"
#include "engine/base/result.h"
#include "engine/live/force_limiter.h"

namespace palpate {

struct DeviceCalibration {
  const DeviceProtocol* protocol = nullptr;  // of a calibration that was read: never null
  double counts_per_metre = 0.0;             // > 0
  double encoder_step_m = 0.0;               // 0: one count
  // 1: counts grow into the block, -1: out of it. The force that pushes out of the
  // block then is a command of the sign -direction: positive commands drive the
  // counts up.
  double direction = 1.0;
  // Of the tool while it is zeroed, or where an absolute device has its
  // 0; negative: outside.
  double rest_position_m = 0.0;
  double fastest_m_per_s = 0.0;  // of the tool; anything above is a jump of the encoder
  // The rest is of devices that push.
  double force_N_per_unit = 0.0;  // unit: see DeviceCommand
  double stuck_after_s = 0.0;     // not a count for so long while pushing: the encoder is stuck
  ForceLimits limits;             // stop_s keeps its default
};

// Of `protocol`, whose name the file carries as its kind. Errors: not JSON, or the first value that is missing, unknown
// or out of range, with path:line:column, found, expected.
Result<DeviceCalibration> parse_calibration(std::string_view text, const std::string& path,
                                            const DeviceProtocol& protocol);

// `folder`/<protocol's name>.json. Errors: as above; the file cannot be read.
Result<DeviceCalibration> read_calibration(const std::string& folder, const DeviceProtocol& protocol);

}  // namespace palpate
