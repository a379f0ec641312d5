// Simulated tools: a hand that explores, and a tool that is moved by mouse or keyboard.
// Thread guarantee: as Device. Deterministic: the same seed, times, targets and forces give the same samples.
#pragma once

#include <array>
#include <atomic>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "engine/base/random_stream.h"
#include "engine/live/device.h"
#include "engine/recording/recording.h"

namespace palpate {

// The motion of a simulated hand that explores a block: slow presses with dwell, taps, pokes, steps, steady contact
// with slow modulation, rests in the air.
// The target of the hand follows minimum-jerk segments (Flash & Hogan 1985)
//   aim(u) = a + (b - a) (10 u^3 - 15 u^4 + 6 u^5),  u in 0..1,
// plus a tremor of 8 to 12 Hz. The hand is a mass that a spring and a damper couple to the target:
//   m a = k (aim - x) + c (d aim/dt - v) - F
// For a press of F newtons the target is the depth at which the block holds F, plus F / k. A derived class knows that
// depth from the material or estimates it from the force.
// Thread guarantee: one thread at a time; `move` and `feel` are wait-free and allocate nothing.

struct HandSettings {
  double mass_kg = 0.12;             // finger, handle and tool
  double stiffness_N_per_m = 800.0;  // of the arm, well braced
  double damping_Ns_per_m = 14.0;    // 0.7 of critical in the air
  double tremor_rms_m = 5e-5;
  double strongest_press_N = 6.0;  // largest target force
  double deepest_m = 0.012;        // largest depth that HandDevice assumes for a force
  double fastest_m_per_s = std::numeric_limits<double>::infinity();  // largest speed of the target, without tremor
};

class HandMotion {
 public:
  HandMotion(const HandSettings& settings, std::uint64_t seed);
  virtual ~HandMotion() = default;

  // One step of `dt_s`, at most 50 us for accuracy: `move` computes the new position, then `feel` takes the force
  // there.
  void move(double dt_s) noexcept;
  void feel(double force_N, double dt_s) noexcept;

  double position_m() const noexcept { return position_m_; }
  double velocity_m_per_s() const noexcept { return velocity_m_per_s_; }
  double acceleration_m_per_s2() const noexcept { return acceleration_m_per_s2_; }

  // Continues at rest at `position_m`, returns into the air and begins the next gesture.
  void resume_at(double position_m) noexcept;

 protected:
  // The depth at which the block holds `force_N` after a short press.
  virtual double held_depth_m(double force_N) const noexcept = 0;
  // Whether a force pushes back. If not, the target of a press is the depth alone, which the hand then reaches.
  virtual bool is_pushed_back() const noexcept { return true; }

  const HandSettings& settings() const noexcept { return settings_; }

 private:
  using Gesture = void (HandMotion::*)();  // plans the segments of one gesture
  struct Segment {
    double target_m = 0.0, duration_s = 0.0;
  };
  struct Press {
    double force_N = 0.0, duration_s = 0.0;
  };
  // A tremor component as a rotating vector, which needs no cosine per step.
  struct Tremor {
    std::complex<double> vector_m, turn;  // real part: displacement; `turn`: rotation in one step
    double rate_rad_per_s = 0.0;
  };
  static constexpr std::size_t kMostSegments = 32;

  void plan();
  void slow_press();
  void taps();
  void poke();
  void steps();
  void modulation();
  void rest();
  // The arguments are structs because braces are evaluated from left to right, so that random numbers are drawn in a
  // defined order.
  void go(Segment segment);
  void press(Press press) { go({aim_for(press.force_N), press.duration_s}); }
  void leave(double fastest_s, double slowest_s);
  // A random position in the air, nearer to the block where fastest_m_per_s is small.
  double air(double from_m, double to_m);
  double aim_for(double force_N) const noexcept {
    return held_depth_m(force_N) + (is_pushed_back() ? force_N / settings_.stiffness_N_per_m : 0.0);
  }
  double any(double from, double to) { return random_.uniform(from, to); }
  void advance_aim(double dt_s);

  HandSettings settings_;
  RandomStream random_;
  std::array<Segment, kMostSegments> segments_{};
  std::size_t segment_count_ = 0, segment_ = 0;
  std::array<Gesture, 16> deck_{};  // in random order; shuffled again when all were used
  std::size_t dealt_ = 0;           // number of used gestures
  double segment_from_m_ = 0.0, segment_time_s_ = 0.0, planned_m_ = 0.0;
  double aim_m_ = 0.0, aim_velocity_m_per_s_ = 0.0, tremor_dt_s_ = 0.0;
  std::array<Tremor, 5> tremor_{};
  double position_m_ = 0.0, velocity_m_per_s_ = 0.0, acceleration_m_per_s2_ = 0.0;
};

// Force limits of simulated tools: 40 N, 5000 N/s, a ramp of 0.3 s.
inline constexpr ForceLimits kSimulatedLimits{40.0, 5000.0, 0.3};

// A simulated tool. Every read advances it by the time since the last one, at most by 20 ms.
class SimulatedDevice : public Device {
 public:
  explicit SimulatedDevice(const char* name) : name_(name) {}

  const std::string& name() const noexcept final { return name_; }
  SensorSpec sensor() const noexcept final;
  Holder holder() const noexcept final { return Holder::simulated; }
  ForceLimits limits() const noexcept final { return kSimulatedLimits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override { force_N_ = force_N; }

  virtual double position_m() const noexcept = 0;
  virtual double velocity_m_per_s() const noexcept = 0;

 protected:
  // Haptics thread: integrates the motion over `gap_s` with a constant force, in sufficiently small steps.
  virtual void advance(double gap_s, double force_N) noexcept = 0;
  void start_at(double now_s) noexcept { now_s_ = now_s; }

 private:
  std::string name_;
  double force_N_ = 0.0;
  double now_s_ = std::numeric_limits<double>::quiet_NaN();  // of the last sample; NaN: none yet
};

// A hand that explores (HandMotion). It does not know the block and estimates its stiffness from the
// rendered force.
class HandDevice final : public SimulatedDevice, private HandMotion {
 public:
  explicit HandDevice(std::uint64_t seed = 1, const HandSettings& settings = {})
      : SimulatedDevice("hand"), HandMotion(settings, seed) {}

  // Haptics thread: see HandMotion::resume_at; `now_s`: steady clock.
  void resume_at(double position_m, double now_s) noexcept;
  double position_m() const noexcept override { return HandMotion::position_m(); }
  double velocity_m_per_s() const noexcept override { return HandMotion::velocity_m_per_s(); }

 private:
  void advance(double gap_s, double force_N) noexcept override;
  double held_depth_m(double force_N) const noexcept override;
  bool is_pushed_back() const noexcept override { return has_felt_; }

  bool has_felt_ = false;             // a force acted in the block; there is none before the first model
  double stiffness_N_per_m_ = 800.0;  // secant, low-pass filtered; the initial value is a guess
};

// Mouse and keyboard set a target y0. The tool is a mass with the impedance of a hand, coupled to the low-pass filtered
// target by a spring and a damper:
//   m a = k (y - x) + c (dy/dt - v) - F,   dy/dt = (y0 - y) / tau
// The rendered force F therefore pushes the tool back, and a jump of the mouse is no jump of the tool. While a key is
// held, every tick moves the target, so that the motion does not depend on the frame rate of the window.
class MouseDevice : public SimulatedDevice, public ToolInput {
 public:
  // The range of targets.
  static constexpr double kHighest_m = -0.03, kDeepest_m = 0.03;
  static constexpr double kIdleTime_s = 20.0;  // see `idle`

  explicit MouseDevice(const char* name = "mouse") : SimulatedDevice(name) {}

  ToolInput* tool_input() noexcept override { return this; }

  // As ToolInput.
  void set_target(double position_m, double now_s) noexcept override;
  void nudge(double by_m, double now_s) noexcept override { set_target(target_m() + by_m, now_s); }
  void drive(double velocity_m_per_s, double limit_m, double now_s) noexcept override;
  void release() noexcept override;
  bool hand_is_exploring() const noexcept override { return false; }
  // Any thread, wait-free.
  double target_m() const noexcept { return target_m_.load(std::memory_order_relaxed); }
  // Any thread, wait-free. Whether no target was set for kIdleTime_s, or none since `release`; false during `drive`.
  bool idle(double now_s) const noexcept;

  // Haptics thread: continues from this position and velocity of the tool.
  void resume_at(double position_m, double velocity_m_per_s, double now_s) noexcept;
  double position_m() const noexcept override { return position_m_; }
  double velocity_m_per_s() const noexcept override { return velocity_m_per_s_; }

 private:
  void advance(double gap_s, double force_N) noexcept override;
  void move_target(double gap_s) noexcept;

  static constexpr double kStart_m = -0.006;
  std::atomic<double> target_m_{kStart_m};
  std::atomic<double> last_input_s_{-std::numeric_limits<double>::infinity()};
  std::atomic<double> drive_m_per_s_{0.0};  // of the key that is held
  std::atomic<double> drive_limit_m_{0.0};
  static_assert(std::atomic<double>::is_always_lock_free);
  // Haptics thread only.
  double smooth_m_ = kStart_m;  // y
  double position_m_ = kStart_m, velocity_m_per_s_ = 0.0;
  double target_velocity_m_per_s_ = 0.0;  // follows drive_m_per_s_
};

// A device that repeats the samples of a recording at their own pace. The rendered force has no effect on it; the
// measured force is the reference for the models.
// Every row is delivered exactly once and unchanged except for the surface offset, so that the loop gives the same bits
// as engine/tick/haptics_tick.h. After its end, a seek or a new offset the stream restarts: the filters are reset.

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
