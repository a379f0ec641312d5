// A tool that is moved by mouse or keyboard. They set a target y0. The tool is a mass with the impedance of a hand,
// coupled to the low-pass filtered target by a spring and a damper:
//   m a = k (y - x) + c (dy/dt - v) - F,   dy/dt = (y0 - y) / tau
// The rendered force F therefore pushes the tool back, and a jump of the mouse is no jump of the tool. While a key is
// held, every tick moves the target, so that the motion does not depend on the frame rate of the window.
#pragma once

#include <atomic>
#include <limits>

#include "devices/virtual/hand_device.h"

namespace palpate {

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
