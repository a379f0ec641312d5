// The interface of a haptic device, a simulated hand or a recording: it returns samples of the tool and takes a force.
// Thread guarantee: `open` and `close` are slow side, before and after the haptics thread. `read` and `write` belong to
// the haptics thread: wait-free, they allocate nothing, make no system call and never throw. A device whose transport
// blocks has its own thread and passes its samples on.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/live/faults.h"
#include "engine/live/force_limiter.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

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
};

// One sample of a device.
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
