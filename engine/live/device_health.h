// The state of a device, for the limiter, the panel and the user.
// Thread guarantee: values; `zeroing_words` is slow side (allocates).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "engine/live/faults.h"

namespace palpate {

// Whether the device knows the position of its tool.
enum class Zeroing : std::uint8_t {
  not_needed,
  needed,      // waits for Device::start_zeroing; no force before
  hold_still,  // measuring; the tool must rest
  done,
};

struct DeviceHealth {
  std::uint32_t faults = 0;  // current faults, device_fault
  Zeroing zeroing = Zeroing::not_needed;
  bool grip_held = false;         // the dead-man switch on the handle is held
  float zeroing_progress = 0.0F;  // 0 to 1 while hold_still
  // Age of the newest sample. Infinite (default): not known to the device; the tick then uses the time since the last
  // sample that it read. Before the first sample there is no force.
  double sample_age_s = std::numeric_limits<double>::infinity();
  double interval_s = 0.0;  // recent interval between samples; 0: not known
  // Time from a command to the report that confirms it; NaN: the device does not confirm.
  double round_trip_s = std::numeric_limits<double>::quiet_NaN();
  // Lag of the force behind the motion: transport, waiting times, half the time for which a force is held. NaN: the
  // device reads and writes in the tick itself.
  double lag_s = std::numeric_limits<double>::quiet_NaN();

  // Whether a force is permitted.
  bool may_push() const noexcept { return faults == 0 && (zeroing == Zeroing::not_needed || zeroing == Zeroing::done); }
};
static_assert(std::is_trivially_copyable_v<DeviceHealth>);

// What the user must do for zeroing; empty if nothing.
inline std::string zeroing_words(const DeviceHealth& health) {
  switch (health.zeroing) {
    case Zeroing::needed:
      return "bring the tool to its marked rest position and start zeroing; no force before";
    case Zeroing::hold_still:
      return "zeroing: hold the tool still (" +
             std::to_string(static_cast<int>(std::lround(100.0F * health.zeroing_progress))) + " %)";
    case Zeroing::not_needed:
    case Zeroing::done:
      break;
  }
  return {};
}

}  // namespace palpate
