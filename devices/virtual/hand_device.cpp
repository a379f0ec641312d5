#include "devices/virtual/hand_device.h"

#include <algorithm>
#include <cmath>

namespace palpate {

constexpr double kSubstep_s = 50e-6;  // see HandMotion::move
constexpr double kLongestStep_s = 0.02;
// The stiffness is not estimated from smaller forces.
constexpr double kLeastForce_N = 0.1;
constexpr double kLearning_s = 0.15;
constexpr double kSoftest_N_per_m = 100.0, kStiffest_N_per_m = 20e3;

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

}  // namespace palpate
