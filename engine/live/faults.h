// The table of all faults of the live loop, from the tick to the panel; all other code uses its rows.
// Thread guarantee: constants; functions that return strings are slow side (allocate).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

// Faults of a tick, bits of LoopSnapshot::faults. The first three are the values of TickFault.
namespace loop_fault {
inline constexpr std::uint32_t kBadSample = 1;
inline constexpr std::uint32_t kTimeNotLater = 2;
inline constexpr std::uint32_t kModelNotFinite = 4;
inline constexpr std::uint32_t kForceNotFinite = 8;  // at the input of the limiter
inline constexpr std::uint32_t kForceClamped = 16;
inline constexpr std::uint32_t kForceSlewed = 32;
inline constexpr std::uint32_t kDeadlineMissed = 64;  // set by the loop; not latched, see missed_deadlines
inline constexpr std::uint32_t kStaleSample = 128;    // too old for a force
inline constexpr std::uint32_t kDeviceFault = 256;    // see LoopSnapshot::device
inline constexpr std::uint32_t kForceThermal = 512;   // clamped by the motor's thermal budget
}  // namespace loop_fault

// Faults of a device, bits of DeviceHealth::faults. While any is set there is no force. Those that lose the position
// also require zeroing.
namespace device_fault {
inline constexpr std::uint32_t kUnplugged = 1;       // reading or writing failed; loses the position
inline constexpr std::uint32_t kLate = 2;            // no recent report
inline constexpr std::uint32_t kOutOfOrder = 4;      // a report older than the one before
inline constexpr std::uint32_t kBurst = 8;           // several reports arrived at once, after a delay
inline constexpr std::uint32_t kCorrupt = 16;        // checksum, length or content is wrong
inline constexpr std::uint32_t kStuck = 32;          // no encoder count in spite of force; loses the position
inline constexpr std::uint32_t kJump = 64;           // faster than the device can move; loses the position
inline constexpr std::uint32_t kReset = 128;         // the firmware restarted; loses the position
inline constexpr std::uint32_t kWriteStalled = 256;  // commands do not reach the device
inline constexpr std::uint32_t kOwn = 512;           // the device itself reports a fault
inline constexpr std::uint32_t kWrongFirmware = 1024;
inline constexpr std::uint32_t kSlow = 2048;  // fewer than 100 samples a second
inline constexpr std::uint32_t kLosesPosition = kUnplugged | kStuck | kJump | kReset;
}  // namespace device_fault

enum class FaultSource : std::uint8_t { device, loop };

struct Fault {
  FaultSource source;
  std::uint32_t bit;
  // What happened and what to do; empty: normal operation, or reported by another row. zeroing_words reports whether
  // the device needs zeroing.
  const char* sentence;
  bool stops_force = true;
  bool alarm = true;  // the user is informed at once and has to acknowledge it
};

// In the order of the reports.
inline constexpr std::array<Fault, 22> kFaults = {{
    {FaultSource::device, device_fault::kUnplugged, "the device is disconnected: connect it again"},
    {FaultSource::device, device_fault::kLate, "reports come late: no force until they are on time again"},
    {FaultSource::device, device_fault::kSlow,
     "the device sends fewer than 100 samples a second: no force until it sends more"},
    {FaultSource::device, device_fault::kOutOfOrder,
     "a report came out of order: no force until reports are in order again"},
    {FaultSource::device, device_fault::kBurst,
     "old reports came in a burst: no force until reports are on time again"},
    {FaultSource::device, device_fault::kCorrupt,
     "a report was corrupted: no force until reports are valid again; check the cable"},
    {FaultSource::device, device_fault::kStuck, "the position is stuck although the motor pushes: check the encoder"},
    {FaultSource::device, device_fault::kJump, "the position jumped: check the encoder"},
    {FaultSource::device, device_fault::kReset, "the firmware restarted: check the power supply of the board"},
    {FaultSource::device, device_fault::kWriteStalled, "commands do not reach the device: no force until they do"},
    {FaultSource::device, device_fault::kOwn, "the device reports a fault of its own: check its motor and encoder"},
    {FaultSource::device, device_fault::kWrongFirmware,
     "the firmware has another version of the protocol: install the one in devices/firmware"},
    {FaultSource::loop, loop_fault::kBadSample,
     "the device gave a sample that is not a number: the force was set to 0"},
    {FaultSource::loop, loop_fault::kTimeNotLater,
     "the device gave a sample that is not later than the previous one: it was skipped", false},
    // Set for any model of the set, selected or not.
    {FaultSource::loop, loop_fault::kModelNotFinite, "a model gave a force that is not a number: 0 N was used instead"},
    {FaultSource::loop, loop_fault::kForceNotFinite, "the force was not a number: 0 N was used instead"},
    {FaultSource::loop, loop_fault::kForceClamped, "the force was above the limit of the device: it was limited",
     false},
    // Normal at every ramp and at hard impacts.
    {FaultSource::loop, loop_fault::kForceSlewed, "", false, false},
    {FaultSource::loop, loop_fault::kStaleSample, "the newest sample of the device is too old: the force was set to 0"},
    {FaultSource::loop, loop_fault::kForceThermal, "the motor is near its thermal limit: the force was reduced", false},
    // Reported by the device's own rows.
    {FaultSource::loop, loop_fault::kDeviceFault, "", true, false},
    {FaultSource::loop, loop_fault::kDeadlineMissed, "a tick was late and missed its deadline", false, false},
}};

// The bits of all rows of `source`, or only of those that stop the force.
constexpr std::uint32_t fault_bits_of(FaultSource source, bool only_stopping = false) noexcept {
  std::uint32_t bits = 0;
  for (const Fault& fault : kFaults)
    if (fault.source == source && (fault.stops_force || !only_stopping)) bits |= fault.bit;
  return bits;
}

namespace loop_fault {
inline constexpr std::uint32_t kStops = fault_bits_of(FaultSource::loop, true);
}

// The index of the row with one bit, which must exist.
constexpr std::size_t fault_index(FaultSource source, std::uint32_t bit) noexcept {
  std::size_t index = 0;
  while (kFaults[index].source != source || kFaults[index].bit != bit) ++index;
  return index;
}

// The sentences of the alarms among `bits`, in the table's order.
inline std::vector<std::string> alarm_words(FaultSource source, std::uint32_t bits) {
  std::vector<std::string> words;
  for (const Fault& fault : kFaults)
    if (fault.alarm && fault.source == source && (bits & fault.bit) != 0) words.emplace_back(fault.sentence);
  return words;
}
// The sentences of a device's alarms among `faults`: what happened and what to do.
inline std::vector<std::string> device_fault_words(std::uint32_t faults) {
  return alarm_words(FaultSource::device, faults);
}

}  // namespace palpate
