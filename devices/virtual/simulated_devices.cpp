#include "devices/virtual/simulated_devices.h"

#include <algorithm>
#include <cmath>

namespace palpate {

constexpr double kLongestStep_s = 0.02;

// Of the hand.
constexpr double kSubstep_s = 50e-6;  // see HandMotion::move
// The stiffness is not estimated from smaller forces.
constexpr double kLeastForce_N = 0.1;
constexpr double kLearning_s = 0.15;
constexpr double kSoftest_N_per_m = 100.0, kStiffest_N_per_m = 20e3;

// Of the mouse.
constexpr HandSettings kArm;                         // mass, stiffness and damping of the coupling
constexpr double kSmoothingTime_s = 0.015;           // tau: two reports of a mouse at 125 Hz
constexpr double kDriveAcceleration_m_per_s2 = 0.3;  // of the velocity of `drive`: 18 mm/s after 60 ms
// A twentieth of the shortest time constant of the coupling, m / c.
constexpr double kMouseSubstep_s = 250e-6;

SensorSpec SimulatedDevice::sensor() const noexcept {
  return {.position_noise_m = 1e-7, .has_velocity = true, .velocity_noise_m_per_s = 1e-4};
}

bool SimulatedDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (now_s <= now_s_) return false;
  if (now_s > now_s_) advance(std::min(now_s - now_s_, kLongestStep_s), force_N_);
  start_at(now_s);
  sample = {};
  sample.tool.time_s = now_s;
  sample.tool.position_m = position_m();
  sample.tool.velocity_m_per_s = velocity_m_per_s();
  return true;
}

void HandDevice::resume_at(double position_m, double now_s) noexcept {
  HandMotion::resume_at(position_m);
  start_at(now_s);
}

void HandDevice::advance(double gap_s, double force_N) noexcept {
  const int steps = static_cast<int>(std::ceil(gap_s / kSubstep_s));
  for (int i = 0; i < steps; ++i) {
    move(gap_s / steps);
    feel(force_N, gap_s / steps);
  }
  if (!(position_m() > 0.0) || !(force_N > kLeastForce_N)) return;
  has_felt_ = true;
  const double secant_N_per_m = std::clamp(force_N / position_m(), kSoftest_N_per_m, kStiffest_N_per_m);
  stiffness_N_per_m_ += std::min(1.0, gap_s / kLearning_s) * (secant_N_per_m - stiffness_N_per_m_);
}

double HandDevice::held_depth_m(double force_N) const noexcept {
  return std::min(force_N / stiffness_N_per_m_, settings().deepest_m);
}

void MouseDevice::set_target(double position_m, double now_s) noexcept {
  if (!std::isfinite(position_m)) return;
  target_m_.store(std::clamp(position_m, kHighest_m, kDeepest_m), std::memory_order_relaxed);
  last_input_s_.store(now_s, std::memory_order_relaxed);
}

// A tick between the two stores sees the old velocity with the new limit. It is on the other side and stops the target.
void MouseDevice::drive(double velocity_m_per_s, double limit_m, double now_s) noexcept {
  if (!std::isfinite(velocity_m_per_s) || !std::isfinite(limit_m)) return;
  drive_limit_m_.store(std::clamp(limit_m, kHighest_m, kDeepest_m), std::memory_order_relaxed);
  drive_m_per_s_.store(velocity_m_per_s, std::memory_order_relaxed);
  last_input_s_.store(now_s, std::memory_order_relaxed);
}

void MouseDevice::release() noexcept {
  drive_m_per_s_.store(0.0, std::memory_order_relaxed);
  last_input_s_.store(-std::numeric_limits<double>::infinity(), std::memory_order_relaxed);
}

bool MouseDevice::idle(double now_s) const noexcept {
  return drive_m_per_s_.load(std::memory_order_relaxed) == 0.0 &&
         !(now_s - last_input_s_.load(std::memory_order_relaxed) < kIdleTime_s);
}

void MouseDevice::resume_at(double position_m, double velocity_m_per_s, double now_s) noexcept {
  smooth_m_ = position_m_ = position_m;
  velocity_m_per_s_ = velocity_m_per_s;
  // A key moves the tool from where it is; the last target may be far away.
  if (drive_m_per_s_.load(std::memory_order_relaxed) != 0.0) target_m_.store(position_m, std::memory_order_relaxed);
  start_at(now_s);
}

void MouseDevice::move_target(double gap_s) noexcept {
  const double wanted_m_per_s = drive_m_per_s_.load(std::memory_order_relaxed);
  const double most_m_per_s = kDriveAcceleration_m_per_s2 * gap_s;
  target_velocity_m_per_s_ += std::clamp(wanted_m_per_s - target_velocity_m_per_s_, -most_m_per_s, most_m_per_s);
  if (target_velocity_m_per_s_ == 0.0) return;
  const double limit_m = drive_limit_m_.load(std::memory_order_relaxed);
  double from_m = target_m();
  double to_m = from_m + gap_s * target_velocity_m_per_s_;
  if (target_velocity_m_per_s_ > 0.0) {
    // The spring of the hand is stretched in contact, so the target may be deeper than the limit of the tool.
    if (position_m_ >= limit_m) to_m = from_m;
    to_m = std::min(to_m, kDeepest_m);
  } else {
    to_m = std::max(to_m, std::min(from_m, limit_m));
  }
  // A target that the window has set in the meantime is newer and stays.
  target_m_.compare_exchange_strong(from_m, to_m, std::memory_order_relaxed);
}

// Semi-implicit Euler, which is stable for much larger steps with these constants.
void MouseDevice::advance(double gap_s, double force_N) noexcept {
  move_target(gap_s);
  const int steps = static_cast<int>(std::ceil(gap_s / kMouseSubstep_s));
  for (int i = 0; i < steps; ++i) {
    const double step_s = gap_s / steps;
    const double drift_m_per_s = (target_m() - smooth_m_) / kSmoothingTime_s;
    smooth_m_ += drift_m_per_s * step_s;
    const double drive_N = kArm.stiffness_N_per_m * (smooth_m_ - position_m_) +
                           kArm.damping_Ns_per_m * (drift_m_per_s - velocity_m_per_s_);
    velocity_m_per_s_ += step_s * (drive_N - force_N) / kArm.mass_kg;
    position_m_ += step_s * velocity_m_per_s_;
  }
}

}  // namespace palpate
