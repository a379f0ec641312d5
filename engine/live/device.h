// The interface of a haptic device, a simulated hand or a recording: it returns samples of the tool and takes a force.
// Thread guarantee: `open` and `close` are slow side, before and after the haptics thread. `read` and `write` belong to
// the haptics thread: wait-free, they allocate nothing, make no system call and never throw. A device whose transport
// blocks has its own thread and passes its samples on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// Limits every force before the device gets it. In this order:
//   stop   no force while the sample is stale or impossible, the device has a fault, the dead-man switch is released
//          or the force is not finite
//   ramp   a factor that grows from 0 to 1 over `ramp_s` from the start, and again after each stop
//   clamp  |force| <= largest_N, and less as the motor warms up
//   slew   |change| <= fastest_N_per_s x the time since the last force, so that neither a fault nor a jump is a kick;
//          only a stop may be faster, so that it takes at most `stop_s`
// Thermal model: tau dH/dt = F^2 - H. H is the heat in N^2, c = continuous_N the force that the motor can hold
// permanently. Above kFoldback c^2 the clamp falls, F^2 <= c^2 + (largest^2 - c^2) (1 - H / c^2) / (1 - kFoldback),
// down to c at H = c^2, so that H never exceeds c^2.
// Thread guarantee: one thread at a time; wait-free, never throws.

struct ForceLimits {
  double largest_N = 10.0;          // peak, > 0
  double fastest_N_per_s = 2000.0;  // > 0
  double ramp_s = 0.3;              // >= 0
  // Force that the motor can hold permanently, > 0; infinite: no thermal limit.
  double continuous_N = std::numeric_limits<double>::infinity();
  double thermal_time_s = 10.0;  // tau, > 0
  double stale_after_s = 0.01;   // maximum age of a sample, > 0
  double stop_s = 0.01;          // time to reduce any force to 0; >= 0
};

struct ForceConditions {
  double sample_age_s = 0.0;  // NaN counts as stale
  bool device_fault = false;
  bool dead_man_released = false;  // a dead-man switch is in use and not held
  bool bad_sample = false;         // the newest sample is impossible; sets no flag
};

// What the limiter did to one force: bits of LoopSnapshot::limiter_flags.
namespace force_limit {
inline constexpr std::uint32_t kNotFinite = 1;  // fault
inline constexpr std::uint32_t kClamped = 2;
inline constexpr std::uint32_t kSlewed = 4;
inline constexpr std::uint32_t kRamping = 8;
inline constexpr std::uint32_t kThermal = 16;      // clamped below largest_N by the thermal model
inline constexpr std::uint32_t kStale = 32;        // fault
inline constexpr std::uint32_t kDeviceFault = 64;  // fault
inline constexpr std::uint32_t kReleased = 128;
}  // namespace force_limit

class ForceLimiter {
 public:
  // H / c^2 from which the clamp decreases, and its initial value, because the earlier temperature is unknown.
  static constexpr double kFoldback = 0.8;

  explicit ForceLimiter(const ForceLimits& limits) noexcept
      : limits_(limits), heat_(kFoldback * limits.continuous_N * limits.continuous_N) {}

  // `commanded_N`: any value; `step_s`: since the last call, clamped to 0 to 10 ms for ramp and slew, so that a stall
  // does not permit a jump. Returns the force to render, finite, and sets `flags`.
  double limit(double commanded_N, double step_s, const ForceConditions& conditions = {}) noexcept;

  std::uint32_t flags() const noexcept { return flags_; }
  double force_N() const noexcept { return force_N_; }
  // H / c^2, dimensionless; 0 without a thermal limit.
  double heat_share() const noexcept;

 private:
  bool stops(double commanded_N, const ForceConditions& conditions) noexcept;
  void warm(double step_s) noexcept;
  double clamp_N() const noexcept;
  void change(double target_N, double most_N) noexcept;

  ForceLimits limits_;
  double share_ = 0.0, force_N_ = 0.0;
  double heat_ = 0.0;  // N^2
  double stop_N_per_s_ = 0.0;
  std::uint32_t flags_ = 0;
  bool stopping_ = false;
};

// The table of all faults of the live loop, from the tick to the panel; all other code uses its rows.
// Thread guarantee: constants; functions that return strings are slow side (allocate).

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
inline std::vector<std::string> device_fault_words(std::uint32_t faults) {
  return alarm_words(FaultSource::device, faults);
}

struct Recording;

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

  // Whether a force is permitted.
  bool may_push() const noexcept { return faults == 0 && (zeroing == Zeroing::not_needed || zeroing == Zeroing::done); }
};

// What the user must do for zeroing; empty if nothing. Slow side.
inline std::string zeroing_words(const DeviceHealth& health) {
  if (health.zeroing == Zeroing::needed)
    return "bring the tool to its marked rest position and start zeroing; no force before";
  if (health.zeroing != Zeroing::hold_still) return {};
  return "zeroing: hold the tool still (" + std::to_string(std::lround(100.0F * health.zeroing_progress)) + " %)";
}

inline constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();

// The age of the force that acted between the last sample and this one: the time since the sample from which that force
// was computed. 0: the device is read and written in the tick itself; NaN: not known.
struct ForceAge {
  double least_s = 0.0, largest_s = 0.0;
  double middle_s() const noexcept { return 0.5 * (least_s + largest_s); }
};

struct DeviceSample {
  ToolSample tool;
  double measured_N = kNoForce;  // the reading of a force sensor; NaN: none
  ForceAge force_age;
  // A new stream begins (a recording starts again): its time may be earlier than that of the last sample, and the
  // filters are reset.
  bool restart = false;
};

// The maximum number of samples that a tick reads from a device: the 20 of a recording at 20 kHz, or at 2 kHz played
// ten times as fast, and a margin.
inline constexpr int kMaxSamplesPerTick = 32;

// A tool that mouse and keys of a window can move. `set_target`: any thread; the rest: the window's thread. Wait-free.
// `now_s`: steady clock.
class ToolInput {
 public:
  virtual ~ToolInput() = default;
  // A target that is not finite is ignored.
  virtual void set_target(double position_m, double now_s) noexcept = 0;
  // Moves the target by `by_m`, positive inwards.
  virtual void nudge(double by_m, double now_s) noexcept = 0;
  // Moves the target at this velocity, positive inwards, until the next call. Inwards it stops when the tool is at
  // `limit_m`, outwards when the target is there. 0 stops it.
  virtual void drive(double velocity_m_per_s, double limit_m, double now_s) noexcept = 0;
  // The user no longer moves the tool.
  virtual void release() noexcept = 0;
  // Whether the tool moves by itself until the user moves it.
  virtual bool hand_is_exploring() const noexcept = 0;
};

// Controls the playback of a recording. Called by the window's thread only; wait-free. Arguments are clamped to the
// valid range.
class ReplayControl {
 public:
  virtual ~ReplayControl() = default;
  virtual void pause(bool paused) noexcept = 0;
  virtual void set_speed(double speed) noexcept = 0;  // times the recording's own pace
  virtual void seek(double at_s) noexcept = 0;        // from the beginning of the recording
  // Pauses and moves by `rows` rows: forwards at most kMaxSamplesPerTick at a time, or backwards, which restarts the
  // stream.
  virtual void step(int rows) noexcept = 0;
  virtual bool paused() const noexcept = 0;
  virtual double speed() const noexcept = 0;
  virtual double playhead_s() const noexcept = 0;
  virtual double duration_s() const noexcept = 0;
  // Sets what is subtracted from every position, so that 0 is the models' surface; the stream restarts.
  virtual void move_surface(double offset_m) noexcept = 0;
  virtual double surface_offset_m() const noexcept = 0;
  virtual const Recording& recording() const noexcept = 0;  // unchanged; any thread
};

// The interval between the samples of a device, or the ticks of a loop. With fewer than 100 a second a force is held so
// long that no useful stiffness is stable (engine/live/force_guard.h); such a device is refused.
// Thread guarantee: one thread at a time; wait-free.
class SampleRate {
 public:
  // 100 Hz with 4 % for the error of a clock and lost samples.
  static constexpr double kLongestInterval_s = 0.0104;

  void add(double step_s) noexcept {
    if (count_ < kSlowSamples) ++count_;
    interval_s_ += (step_s - interval_s_) / std::min(count_, kFastSamples);
    // One pause is no rate.
    slow_s_ += (std::min(step_s, 2.0 * kLongestInterval_s) - slow_s_) / count_;
    fast_s_ = slow_s_ < kFastAgain_s ? fast_s_ + step_s : 0.0;
    too_slow_ = count_ >= kFewest && (too_slow_ ? fast_s_ < kAgainAfter_s : slow_s_ > kLongestInterval_s);
  }
  // The mean of about ten samples, s; 0 before the first interval.
  double interval_s() const noexcept { return interval_s_; }
  // By the mean of about fifty samples, so that a few lost ones do not count; until it was above 105 Hz for a second,
  // so that a rate near the limit does not switch the force on and off.
  bool too_slow() const noexcept { return too_slow_; }

 private:
  static constexpr double kFewest = 8.0, kFastSamples = 10.0, kSlowSamples = 50.0;
  static constexpr double kFastAgain_s = 1.0 / 105.0, kAgainAfter_s = 1.0;
  double count_ = 0.0, interval_s_ = 0.0, slow_s_ = 0.0, fast_s_ = 0.0;
  bool too_slow_ = false;
};

// The refusal of a device at its start. Slow side.
inline Error too_slow(const std::string& device, double interval_s) {
  return Error{device + ": sends " + fixed(1.0 / interval_s, 0) +
               " samples a second, expected 100 to 10000; raise the rate of the device's program"};
}

// The holder of the tool, on which the written force acts; none: a recording is replayed.
enum class Holder { none, simulated, person };

class Device {
 public:
  virtual ~Device() = default;

  virtual const std::string& name() const noexcept = 0;
  virtual SensorSpec sensor() const noexcept = 0;
  virtual Holder holder() const noexcept = 0;
  // Whether its samples have a measured force.
  virtual bool measures_force() const noexcept { return false; }
  // The limits of the force for this device, see ForceLimiter.
  virtual ForceLimits limits() const noexcept = 0;

  // Slow side, blocking. Errors: the reason, and advice.
  virtual Status open() { return {}; }
  virtual void close() noexcept {}

  // The next sample up to `now_s` (steady clock, increasing); false: none since the last call. The loop calls it up to
  // kMaxSamplesPerTick times a tick. If there are more, a live device must skip the oldest and a recording must wait,
  // so that samples do not accumulate.
  virtual bool read(double now_s, DeviceSample& sample) noexcept = 0;
  // The force to render from now on, limited and finite.
  virtual void write(double force_N) noexcept = 0;
  // Haptics thread, wait-free: the state of the device at `now_s`, with its faults. The loop renders no force while
  // DeviceHealth::may_push is false.
  virtual DeviceHealth health(double) noexcept { return {}; }

  // Any thread, wait-free: declares that the tool is at its marked rest position. The result is in `health`; a device
  // without zeroing ignores it.
  virtual void start_zeroing() noexcept {}

  // Slow side: a note for the user on the selection of this device, e.g. why "auto" selected another; may be empty.
  virtual std::string note() const { return {}; }

  // Slow side: further interfaces of this device, valid during its lifetime; null: not available.
  virtual ToolInput* tool_input() noexcept { return nullptr; }
  virtual ReplayControl* replay() noexcept { return nullptr; }
};

}  // namespace palpate
