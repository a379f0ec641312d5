// What a device knows of its own state, for the limiter, the panel and people.
//
// Thread guarantee: values; the words are slow side (they allocate).
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace palpate {

// What is wrong with a device, bits. While any is set the device gets no force.
// Those that lose the position also ask for zeroing again.
namespace device_fault {
inline constexpr std::uint32_t kUnplugged = 1;       // reading or writing failed; loses the position
inline constexpr std::uint32_t kLate = 2;            // no report, or none that is recent
inline constexpr std::uint32_t kOutOfOrder = 4;      // a report older than the one before
inline constexpr std::uint32_t kBurst = 8;           // reports that had queued up came at once
inline constexpr std::uint32_t kCorrupt = 16;        // checksum, length or content is wrong
inline constexpr std::uint32_t kStuck = 32;          // not one count in spite of force; loses the position
inline constexpr std::uint32_t kJump = 64;           // faster than the device can move; loses the position
inline constexpr std::uint32_t kReset = 128;         // the firmware started again; loses the position
inline constexpr std::uint32_t kWriteStalled = 256;  // commands do not get through
inline constexpr std::uint32_t kOwn = 512;           // the device itself reports a fault
inline constexpr std::uint32_t kWrongFirmware = 1024;
inline constexpr std::uint32_t kLosesPosition = kUnplugged | kStuck | kJump | kReset;
inline constexpr std::uint32_t kAll = 2047;
}  // namespace device_fault

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
  double sample_age_s = 0.0;      // of the newest sample
  // From a command to the report that confirms it; NaN: the device confirms none.
  double round_trip_s = std::numeric_limits<double>::quiet_NaN();

  bool may_push() const noexcept {
    return faults == 0 && (zeroing == Zeroing::not_needed || zeroing == Zeroing::done);
  }
};
static_assert(std::is_trivially_copyable_v<DeviceHealth>);

// A sentence for each bit set: what happened and what to do.
std::vector<std::string> device_fault_words(std::uint32_t faults);
// For the panel: what to do for zeroing; empty when there is nothing to do.
std::string zeroing_words(const DeviceHealth& health);

}  // namespace palpate
