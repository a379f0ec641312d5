// What holds the tool: a haptic device, a simulated hand, a recording. Samples
// come out, a force goes in.
//
// Thread guarantee: `open` and `close` are slow side, before and after the
// haptics thread. `read` and `write` belong to the haptics thread: wait-free,
// they allocate nothing, make no system call and never throw. A device whose
// transport blocks has its own thread and hands its newest sample over.
#pragma once

#include <limits>
#include <string>

#include "engine/base/result.h"
#include "engine/live/device_health.h"
#include "engine/live/force_limiter.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

struct Recording;

// One sample of a device.
struct DeviceSample {
  ToolSample tool;
  // What a force sensor said, newtons; NaN without one.
  double measured_force_N = std::numeric_limits<double>::quiet_NaN();
  // A new stream begins here (a recording starts over): its time may be earlier
  // than the last sample's, and the filters forget what was before.
  bool restart = false;
};

// Most samples that one tick takes from a device: a recording at 20 kHz, or one
// at 2 kHz played ten times too fast, and half as much again.
inline constexpr int kMaxSamplesPerTick = 32;

// A tool that a window's mouse and keys may move. One thread, the window's;
// wait-free. `now_s`: steady clock.
class ToolInput {
 public:
  virtual ~ToolInput() = default;
  // A target that is not finite is ignored.
  virtual void set_target(double position_m, double now_s) noexcept = 0;
  virtual void nudge(double by_m, double now_s) noexcept = 0;
  // Nobody moves it any more.
  virtual void leave() noexcept = 0;
  // Whether the tool moves by itself until somebody takes over.
  virtual bool hand_is_exploring() const noexcept = 0;
};

// A recording's playback. One thread, the window's; wait-free. Each limits what it
// is given to what it can do.
class ReplayControl {
 public:
  virtual ~ReplayControl() = default;
  virtual void pause(bool paused) noexcept = 0;
  virtual void set_speed(double speed) noexcept = 0;  // times the recording's own pace
  virtual void seek(double at_s) noexcept = 0;        // from the beginning of the recording
  // Pauses, and goes so many rows on (at most kMaxSamplesPerTick at a time), or back,
  // where the stream restarts.
  virtual void step(int rows) noexcept = 0;
  virtual bool paused() const noexcept = 0;
  virtual double speed() const noexcept = 0;
  virtual double playhead_s() const noexcept = 0;
  virtual double duration_s() const noexcept = 0;
  // What is subtracted from every position, so that 0 is where the models' surface
  // is; the stream restarts with it.
  virtual void move_surface(double offset_m) noexcept = 0;
  virtual double surface_offset_m() const noexcept = 0;
  virtual const Recording& recording() const noexcept = 0;  // as it was read; any thread
};

// What feels the force that is written.
enum class Holder { nobody, simulated, person };

class Device {
 public:
  virtual ~Device() = default;

  virtual const std::string& name() const noexcept = 0;
  virtual SensorSpec sensor() const noexcept = 0;
  virtual Holder holder() const noexcept = 0;
  // Whether its samples carry the force of a sensor.
  virtual bool measures_force() const noexcept { return false; }
  // What the device may be given, see ForceLimiter.
  virtual ForceLimits limits() const noexcept = 0;

  // Slow side, blocking. Errors: says why not, and what to do.
  virtual Status open() { return {}; }
  virtual void close() noexcept {}

  // The next sample that has come by `now_s` (steady clock, increasing); false:
  // none since the last call. Several may have: the loop asks again, up to
  // kMaxSamplesPerTick times a tick, and the device makes sure that what it did
  // not hand over in time is neither lost nor piled up.
  virtual bool read(double now_s, DeviceSample& sample) noexcept = 0;
  // The force to render from now on, limited and finite.
  virtual void write(double force_N) noexcept = 0;
  // Haptics thread, wait-free: how the device is at `now_s`. What may fail says
  // so here; the loop gives no force while `may_push()` is false.
  virtual DeviceHealth health(double) noexcept { return {}; }

  // Any thread, wait-free: the tool is at its marked rest position now. Answered
  // in `health`; ignored by a device that needs no zeroing.
  virtual void start_zeroing() noexcept {}

  // Slow side: what people should know of the choice of this device, e.g. what
  // "auto" fell back to and why; empty when there is nothing to say.
  virtual std::string note() const { return {}; }

  // Slow side: what else this device can be asked for, as long as it lives; null: it
  // cannot.
  virtual ToolInput* mouse() noexcept { return nullptr; }
  virtual ReplayControl* replay() noexcept { return nullptr; }
};

}  // namespace palpate
