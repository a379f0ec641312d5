// Simulated tools: a hand that explores, and a tool that is moved by mouse or keyboard.
// Thread guarantee: as Device. Deterministic: the same seed, times, targets and forces give the same samples.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <string>

#include "devices/virtual/hand_motion.h"
#include "engine/live/device.h"

namespace palpate {

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

// A hand that explores (devices/virtual/hand_motion.h). It does not know the block and estimates its stiffness from the
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

}  // namespace palpate
