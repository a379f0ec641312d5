// A device that repeats the samples of a recording at their own pace. The rendered force has no effect on it; the
// measured force is the reference for the models.
// Every row is delivered exactly once and unchanged except for the surface offset, so that the loop gives the same bits
// as engine/tick/replay.h. After its end, a seek or a new offset the stream restarts: the filters are reset.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "devices/virtual/simulated_devices.h"
#include "engine/live/device.h"
#include "engine/recording/recording.h"

namespace palpate {

inline constexpr double kSlowestReplay = 0.05, kFastestReplay = 10.0;

class ReplayDevice final : public Device, public ReplayControl {
 public:
  // `recording` satisfies the rules of the reader. The constructor identifies its sensor.
  explicit ReplayDevice(Recording recording);

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override { return sensor_; }
  Holder holder() const noexcept override { return Holder::none; }
  bool measures_force() const noexcept override { return true; }
  ForceLimits limits() const noexcept override { return kSimulatedLimits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double) noexcept override {}
  // The samples of a paused or slow recording do not count as late.
  DeviceHealth health(double) noexcept override {
    DeviceHealth health;
    if (started_) health.sample_age_s = 0.0;
    return health;
  }
  ReplayControl* replay() noexcept override { return this; }

  // As ReplayControl, any thread. `speed`: clamped to kSlowestReplay .. kFastestReplay. Values that are not finite are
  // ignored.
  void pause(bool paused) noexcept override { paused_.store(paused, std::memory_order_relaxed); }
  void set_speed(double speed) noexcept override;
  void seek(double at_s) noexcept override;
  void step(int rows) noexcept override;
  bool paused() const noexcept override { return paused_.load(std::memory_order_relaxed); }
  double speed() const noexcept override { return speed_.load(std::memory_order_relaxed); }
  double playhead_s() const noexcept override { return shown_s_.load(std::memory_order_relaxed); }
  double duration_s() const noexcept override { return time_of(recording_.rows.size() - 1); }
  void move_surface(double offset_m) noexcept override;
  double surface_offset_m() const noexcept override { return surface_offset_m_.load(std::memory_order_relaxed); }
  const Recording& recording() const noexcept override { return recording_; }

 private:
  // From the beginning of the recording.
  double time_of(std::size_t row) const noexcept {
    return recording_.rows[row].time_s - recording_.rows.front().time_s;
  }
  void move_playhead(double now_s) noexcept;
  void go_to(double at_s) noexcept;
  void go_by(int rows) noexcept;

  std::string name_;
  Recording recording_;
  SensorSpec sensor_;
  std::atomic<bool> paused_{false};
  std::atomic<double> speed_{1.0};
  std::atomic<double> seek_s_{-1.0};  // requested seek; below 0: none
  std::atomic<int> rows_{0};          // requested steps
  std::atomic<double> shown_s_{0.0};
  std::atomic<double> surface_offset_m_{0.0};
  static_assert(std::atomic<double>::is_always_lock_free);
  // Haptics thread only.
  double playhead_s_ = 0.0, now_s_ = 0.0;
  double moved_m_ = 0.0;  // surface offset of the present stream
  std::size_t next_ = 0;
  int handed_over_ = 0;  // rows read in this tick
  bool restart_ = true, started_ = false;
};

}  // namespace palpate
