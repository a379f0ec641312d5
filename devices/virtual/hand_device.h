// A simulated hand that explores (devices/virtual/hand_motion.h). It does not know the block and estimates its
// stiffness from the rendered force. Thread guarantee: as Device; deterministic: the same seed, times and forces give
// the same samples.
#pragma once

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

}  // namespace palpate
