// Everything that can be wrong in the live loop, from the tick to the panel: one row for
// each, and nothing about a fault is written anywhere else.
//
// Thread guarantee: constants; what returns strings is slow side (allocates).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

// What a tick found wrong, bits of LoopSnapshot::faults. The first three are those of
// TickFault, in its order.
namespace loop_fault {
inline constexpr std::uint32_t kBadSample = 1;
inline constexpr std::uint32_t kTimeNotLater = 2;
inline constexpr std::uint32_t kModelNotFinite = 4;
inline constexpr std::uint32_t kForceNotFinite = 8;  // reached the limiter
inline constexpr std::uint32_t kForceClamped = 16;
inline constexpr std::uint32_t kForceSlewed = 32;
inline constexpr std::uint32_t kDeadlineMissed = 64;  // set by the loop; not latched, missed_deadlines tells
inline constexpr std::uint32_t kStaleSample = 128;    // too old to push by
inline constexpr std::uint32_t kDeviceFault = 256;    // see LoopSnapshot::device
inline constexpr std::uint32_t kForceThermal = 512;   // clamped by the motor's thermal budget
}  // namespace loop_fault

// What is wrong with a device, bits of DeviceHealth::faults. While any is set the device
// gets no force. Those that lose the position also ask for zeroing again.
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
}  // namespace device_fault

// What the window sees of the loop from outside.
namespace window_fault {
inline constexpr std::uint32_t kDropped = 1;  // snapshots were lost before they were shown
inline constexpr std::uint32_t kStall = 2;    // no tick for a while
}  // namespace window_fault

enum class FaultSource : std::uint8_t { device, loop, window };

struct Fault {
  FaultSource source;
  std::uint32_t bit;
  // What happened and what to do; empty: part of normal running, or told by others. Whether to zero the device is
  // told by zeroing_words, for not every device needs it.
  const char* sentence;
  bool stops_force;
  bool alarm;  // the user needs to be told at once, and has to acknowledge it
};

// In the order in which they are told.
inline constexpr std::array<Fault, 23> kFaults = {{
    {FaultSource::device, device_fault::kUnplugged, "the device is gone: connect it again", true, true},
    {FaultSource::device, device_fault::kLate, "reports come late: no force until they are on time again", true, true},
    {FaultSource::device, device_fault::kOutOfOrder,
     "a report came out of order: no force until they are in order again", true, true},
    {FaultSource::device, device_fault::kBurst, "old reports came in a burst: no force until they are on time again",
     true, true},
    {FaultSource::device, device_fault::kCorrupt,
     "a report was corrupted: no force until they are good again; check the cable", true, true},
    {FaultSource::device, device_fault::kStuck, "the position is stuck although the motor pushes: check the encoder",
     true, true},
    {FaultSource::device, device_fault::kJump, "the position jumped: check the encoder", true, true},
    {FaultSource::device, device_fault::kReset, "the firmware started again: check its supply", true, true},
    {FaultSource::device, device_fault::kWriteStalled, "commands do not reach the device: no force until they do", true,
     true},
    {FaultSource::device, device_fault::kOwn, "the device reports a fault of its own: check its motor and encoder",
     true, true},
    {FaultSource::device, device_fault::kWrongFirmware,
     "the firmware speaks another version of the protocol: install the one in devices/", true, true},
    {FaultSource::loop, loop_fault::kBadSample, "the device gave a sample that is not a number; the force let go", true,
     true},
    {FaultSource::loop, loop_fault::kTimeNotLater,
     "the device gave a sample that is not later than the one before; skipped", false, true},
    // That of the one model alone, active or not.
    {FaultSource::loop, loop_fault::kModelNotFinite, "a model gave a force that is not a number; 0 N instead", true,
     true},
    {FaultSource::loop, loop_fault::kForceNotFinite, "the force became not a number; 0 N instead", true, true},
    {FaultSource::loop, loop_fault::kForceClamped, "the force was above what the device may be given; held back", false,
     true},
    // The limiter slews at every ramp, and when the tool hits the block hard: that is what it is for.
    {FaultSource::loop, loop_fault::kForceSlewed, "", false, false},
    {FaultSource::loop, loop_fault::kStaleSample, "the device's newest sample is too old to push by; the force let go",
     true, true},
    {FaultSource::loop, loop_fault::kForceThermal, "the motor is near its thermal limit; the force held back", false,
     true},
    // Told by the device's own rows.
    {FaultSource::loop, loop_fault::kDeviceFault, "", true, false},
    {FaultSource::loop, loop_fault::kDeadlineMissed, "a tick was late and its deadline missed", false, false},
    {FaultSource::window, window_fault::kDropped, "the window was too slow to show every tick", false, false},
    {FaultSource::window, window_fault::kStall, "the haptics loop stood still for more than 50 ms", false, true},
}};

// The bits of all rows of `source`, or of those that take the force away.
constexpr std::uint32_t fault_bits_of(FaultSource source, bool only_stopping = false) noexcept {
  std::uint32_t bits = 0;
  for (const Fault& fault : kFaults) {
    if (fault.source == source && (fault.stops_force || !only_stopping)) bits |= fault.bit;
  }
  return bits;
}

namespace loop_fault {
inline constexpr std::uint32_t kStops = fault_bits_of(FaultSource::loop, true);
}
namespace device_fault {
inline constexpr std::uint32_t kAll = fault_bits_of(FaultSource::device);
}

// The row of one bit, which there is.
constexpr std::size_t fault_index(FaultSource source, std::uint32_t bit) noexcept {
  std::size_t index = 0;
  while (kFaults[index].source != source || kFaults[index].bit != bit) ++index;
  return index;
}

// The sentences of the alarms among `bits`, in the table's order.
std::vector<std::string> alarm_words(FaultSource source, std::uint32_t bits);
// Of a device: what happened and what to do, a sentence for each bit set.
inline std::vector<std::string> device_fault_words(std::uint32_t faults) {
  return alarm_words(FaultSource::device, faults);
}

}  // namespace palpate
