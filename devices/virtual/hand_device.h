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

// What a simulated tool may be given.
inline constexpr ForceLimits kSimulatedLimits{40.0, 5000.0, 0.3};

// A simulated tool: time goes on between reads, 20 ms at most; a longer gap is a stall in
// which nothing moved.
class SimulatedDevice : public Device {
 public:
  explicit SimulatedDevice(const char* name) : name_(name) {}

  const std::string& name() const noexcept final { return name_; }
  // Exact up to these.
  SensorSpec sensor() const noexcept final;
  Holder holder() const noexcept final { return Holder::simulated; }
  ForceLimits limits() const noexcept final { return kSimulatedLimits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override { force_N_ = force_N; }

  virtual double position_m() const noexcept = 0;
  virtual double velocity_m_per_s() const noexcept = 0;

 protected:
  // Haptics thread: against a constant force, in steps that keep it accurate.
  virtual void advance(double gap_s, double force_N) noexcept = 0;
  void start_at(double now_s) noexcept {
    now_s_ = now_s;
    started_ = true;
  }

 private:
  std::string name_;
  double force_N_ = 0.0;
  double now_s_ = 0.0;
  bool started_ = false;
};

class HandDevice final : public SimulatedDevice {
 public:
  explicit HandDevice(std::uint64_t seed = 1, const HandSettings& settings = {})
      : SimulatedDevice("hand"), hand_(settings, seed) {}

  // Haptics thread: see HandMotion::resume_at; `now_s` as for read.
  void resume_at(double position_m, double now_s) noexcept;
  double position_m() const noexcept override { return hand_.position_m(); }
  double velocity_m_per_s() const noexcept override { return hand_.velocity_m_per_s(); }

 private:
  void advance(double gap_s, double force_N) noexcept override;
  LearningHand hand_;
};

}  // namespace palpate
