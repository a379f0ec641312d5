// Calibration and limits of one kind of device: the JSON file of its protocol in assets/devices/.
// Thread guarantee: slow side only.
#pragma once

#include <string>

#include "devices/link/device_protocol.h"
#include "engine/base/result.h"
#include "engine/live/force_limiter.h"

namespace palpate {

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
