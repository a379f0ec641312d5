#include "devices/virtual/hand_device.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// The hand's integration is accurate at 50 us (devices/virtual/hand_motion.h).
constexpr double kSubstep_s = 50e-6;
constexpr double kLongestStep_s = 0.02;
// Contact too light to tell a stiffness from.
constexpr double kFeelable_N = 0.1;
constexpr double kLearning_s = 0.15;
constexpr double kSoftest_N_per_m = 100.0;
constexpr double kStiffest_N_per_m = 20e3;
// It never aims deeper than this, however soft the block feels: a block that
// does not answer is not pressed through.
constexpr double kDeepest_m = 0.012;

}  // namespace

SensorSpec simulated_sensor() noexcept {
  SensorSpec sensor;
  sensor.position_noise_m = 1e-7;
  sensor.has_velocity = true;
  sensor.velocity_noise_m_per_s = 1e-4;
  return sensor;
}

ForceLimits simulated_limits() noexcept { return {40.0, 5000.0, 0.3}; }

void LearningHand::learn(double force_N, double step_s) noexcept {
  if (!(position_m() > 0.0) || !(force_N > kFeelable_N)) return;
  const double felt = std::clamp(force_N / position_m(), kSoftest_N_per_m, kStiffest_N_per_m);
  stiffness_N_per_m_ += std::min(1.0, step_s / kLearning_s) * (felt - stiffness_N_per_m_);
}

double LearningHand::held_depth_m(double force_N) const noexcept {
  return std::min(force_N / stiffness_N_per_m_, kDeepest_m);
}

double advance_hand(HandMotion& hand, double from_s, double to_s, double force_N) noexcept {
  const double gap_s = std::clamp(to_s - from_s, 0.0, kLongestStep_s);
  const int steps = static_cast<int>(std::ceil(gap_s / kSubstep_s));
  for (int i = 0; i < steps; ++i) {
    hand.move(gap_s / steps);
    hand.feel(force_N, gap_s / steps);
  }
  return gap_s;
}

HandDevice::HandDevice(std::uint64_t seed, const HandSettings& settings) : hand_(settings, seed) {}

SensorSpec HandDevice::sensor() const noexcept { return simulated_sensor(); }
ForceLimits HandDevice::limits() const noexcept { return simulated_limits(); }

void HandDevice::resume_at(double position_m, double now_s) noexcept {
  hand_.resume_at(position_m);
  now_s_ = now_s;
  started_ = true;
}

bool HandDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (started_ && !(now_s > now_s_)) return false;
  if (started_) {
    const double step_s = advance_hand(hand_, now_s_, now_s, force_N_);
    hand_.learn(force_N_, step_s);
  }
  started_ = true;
  now_s_ = now_s;
  sample = {};
  sample.tool.time_s = now_s;
  sample.tool.position_m = hand_.position_m();
  sample.tool.velocity_m_per_s = hand_.velocity_m_per_s();
  return true;
}

}  // namespace palpate
