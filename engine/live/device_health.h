// What a device knows of its own state, for the limiter, the panel and people.
//
// Thread guarantee: values; the words are slow side (they allocate).
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "engine/live/faults.h"

namespace palpate {

// Whether the device knows where its tool is.
enum class Zeroing : std::uint8_t {
  not_needed,
  needed,      // waits for Device::start_zeroing; no force until it is done
  hold_still,  // measuring; the tool has to rest
  done,
};

struct DeviceHealth {
  std::uint32_t faults = 0;  // device_fault, now
  Zeroing zeroing = Zeroing::not_needed;
  bool grip_held = false;         // of a dead-man switch on the handle
  float zeroing_progress = 0.0F;  // 0 to 1 while hold_still
  // Of the newest sample. Infinite, the default: the device does not say, and the tick counts from the last sample
  // that it was given; before the first there is no force.
  double sample_age_s = std::numeric_limits<double>::infinity();
  double interval_s = 0.0;  // between samples, of late; 0: not known
  // From a command to the report that confirms it; NaN: the device confirms none.
  double round_trip_s = std::numeric_limits<double>::quiet_NaN();
  // From a motion to the force that answers it: transport, waits, half the time for which a force is held. NaN: the
  // device takes part in the tick itself.
  double late_s = std::numeric_limits<double>::quiet_NaN();

  bool may_push() const noexcept { return faults == 0 && (zeroing == Zeroing::not_needed || zeroing == Zeroing::done); }
};
static_assert(std::is_trivially_copyable_v<DeviceHealth>);

// For the panel: what to do for zeroing; empty when there is nothing to do.
std::string zeroing_words(const DeviceHealth& health);

}  // namespace palpate
