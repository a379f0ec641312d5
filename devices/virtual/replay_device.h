// A recording as a device: its samples at its own pace, over and over. It cannot
// feel anything; its measured force is the reference for the models.
//
// Every row is handed over exactly once and unchanged but for the surface offset,
// so a loop fed with it computes what engine/tick/replay.h computes, bit for bit. At
// the end, after a seek and with another offset the stream restarts: the filters forget, as at the start of a replay.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>

#include "devices/virtual/hand_device.h"
#include "engine/live/device.h"
#include "engine/recording/recording.h"

namespace palpate {

inline constexpr double kSlowestReplay = 0.05;
inline constexpr double kFastestReplay = 10.0;

class ReplayDevice final : public Device, public ReplayControl {
 public:
  // `recording`: as the reader accepts it; its sensor is identified here.
  explicit ReplayDevice(Recording recording);

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override { return sensor_; }
  Holder holder() const noexcept override { return Holder::none; }
  bool measures_force() const noexcept override { return true; }
  ForceLimits limits() const noexcept override { return kSimulatedLimits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double) noexcept override {}
  // A recording that is paused or slow is not late.
  DeviceHealth health(double) noexcept override {
    DeviceHealth health;
    if (started_) health.sample_age_s = 0.0;
    return health;
  }
  ReplayControl* replay() noexcept override { return this; }

  // Any thread, wait-free. `speed`: times the recording's own pace, kept between
  // kSlowestReplay and kFastestReplay, ignored when not finite; `at_s`: from the
  // beginning of the recording, kept inside it.
  void pause(bool paused) noexcept override { paused_.store(paused, std::memory_order_relaxed); }
  void set_speed(double speed) noexcept override;
  void seek(double at_s) noexcept override;
  void step(int rows) noexcept override;
  bool paused() const noexcept override { return paused_.load(std::memory_order_relaxed); }
  double speed() const noexcept override { return speed_.load(std::memory_order_relaxed); }
  double playhead_s() const noexcept override { return shown_s_.load(std::memory_order_relaxed); }
  double duration_s() const noexcept override { return duration_s_; }
  // Any thread, wait-free; ignored when not finite.
  void move_surface(double offset_m) noexcept override;
  double surface_offset_m() const noexcept override { return surface_offset_m_.load(std::memory_order_relaxed); }
  const Recording& recording() const noexcept override { return recording_; }

 private:
  void move_playhead(double now_s) noexcept;
  void go_to(double at_s) noexcept;
  void go_by(int rows) noexcept;

  std::string name_;
  Recording recording_;
  SensorSpec sensor_;
  double duration_s_ = 0.0;
  std::atomic<bool> paused_{false};
  std::atomic<double> speed_{1.0};
  std::atomic<double> seek_s_{-1.0};  // below 0: none
  std::atomic<int> rows_{0};          // to go by
  std::atomic<double> shown_s_{0.0};
  std::atomic<double> surface_offset_m_{0.0};
  static_assert(std::atomic<double>::is_always_lock_free);
  // Haptics thread's own.
  double playhead_s_ = 0.0;
  double now_s_ = 0.0;
  double moved_m_ = 0.0;  // the offset of the stream
  std::size_t next_ = 0;
  int handed_over_ = 0;  // in this tick
  bool restart_ = true;
  bool started_ = false;
};

}  // namespace palpate
