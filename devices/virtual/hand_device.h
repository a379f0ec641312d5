// A hand that explores by itself: slow presses, taps, pokes, holds, rests. It is
// a mass on a spring and a damper (devices/virtual/hand_motion.h) and feels the rendered
// force, which really pushes it back. It does not know the block: from what it
// feels it learns how deep a force lies, as a person would.
//
// Thread guarantee: as Device; deterministic: the same seed, times and forces
// give the same samples.
#pragma once

#include <cstdint>
#include <string>

#include "devices/virtual/hand_motion.h"
#include "engine/live/device.h"

namespace palpate {

// A hand that learns the block's stiffness from what it feels.
class LearningHand final : public HandMotion {
 public:
  LearningHand(const HandSettings& settings, std::uint64_t seed) : HandMotion(settings, seed) {}

  // The force that is felt at the present position, for `step_s`.
  void learn(double force_N, double step_s) noexcept;

 protected:
  double held_depth_m(double force_N) const noexcept override;

 private:
  double stiffness_N_per_m_ = 800.0;  // secant, at the forces felt of late; a guess at first
};

// Advances `hand` from `from_s` to `to_s` against a constant force, in steps that
// keep its integration accurate; 20 ms at most, a longer gap is a stall in which
// nothing moved. Returns the time simulated, seconds.
double advance_hand(HandMotion& hand, double from_s, double to_s, double force_N) noexcept;

class HandDevice final : public Device {
 public:
  explicit HandDevice(std::uint64_t seed = 1, const HandSettings& settings = {});

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override;
  bool renders_force() const noexcept override { return true; }
  ForceLimits limits() const noexcept override;
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override { force_N_ = force_N; }

  // Haptics thread: see HandMotion::resume_at; `now_s` as for read.
  void resume_at(double position_m, double now_s) noexcept;
  double position_m() const noexcept { return hand_.position_m(); }
  double velocity_m_per_s() const noexcept { return hand_.velocity_m_per_s(); }

 private:
  std::string name_ = "hand";
  LearningHand hand_;
  double force_N_ = 0.0;
  double now_s_ = 0.0;
  bool started_ = false;
};

// What a simulated sensor on a simulated tool says: exact up to these.
SensorSpec simulated_sensor() noexcept;
// What a simulated tool may be given.
ForceLimits simulated_limits() noexcept;

}  // namespace palpate
