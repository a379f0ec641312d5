// Simulates a tool in a hand, in closed loop with the live tick. Time is simulated;
// the same settings give bit-identical results.
//
//   m a = k (aim - x) + c (d aim/dt - v) + push - F
// at 20 kHz. In each tick LiveTick::run reads x in whole encoder steps and writes a force.
// F is that force, applied `delay_s` later and held until the next one.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "engine/live/live_tick.h"

namespace palpate {

struct Grip {
  std::string name;
  double mass_kg = 0.12;  // tool, handle and the moving part of the hand
  double stiffness_N_per_m = 800.0, damping_Ns_per_m = 14.0;
};

// From a light contact of a finger to a clenched fist: stiffness and damping rise
// together with the grip (Hajian & Howe 1997; Hasser & Cutkosky 2002), the damping is
// 0.5 to 0.7 of critical. `braced` is the hand of devices/virtual/simulated_devices.h.
// The last is a free mass without stiffness and damping.
inline const std::array<Grip, 4> kGrips{{{"relaxed", 0.08, 150.0, 3.5},
                                         {"braced", 0.12, 800.0, 14.0},
                                         {"clenched", 0.3, 2000.0, 30.0},
                                         {"mass alone", 0.1, 0.0, 0.0}}};
inline const Grip& mass_alone() { return kGrips.back(); }
inline bool held(const Grip& grip) { return grip.stiffness_N_per_m > 0.0; }

// The simulation has this many steps of time within the period of a tick, 1 ms.
inline constexpr std::int64_t kPeriodSteps = 20;

struct ClosedLoopSettings {
  Grip grip;
  double encoder_step_m = 30e-6;
  double delay_s = 1e-3;
  // Moves the deadline of the next tick, in steps, and returns the step of the tick; null: ticks are even.
  std::function<std::int64_t(std::int64_t& deadline)> uneven{};
  ForceLimits limits{10.0, 5000.0, 0.0};  // of a typical force-feedback device
  double sample_s = 0.0;                  // interval of the samples; 0: one sample in each tick
  ForceScale scale{};
};

// Energy between the tool and the rendered force, J: `put_in_J` by the tool while the
// force resists the motion, `got_out_J` by the force while it drives the motion.
struct LoopEnergy {
  double put_in_J = 0.0, got_out_J = 0.0;
  double balance_J() const { return put_in_J - got_out_J; }
};

class SimulatedTool final : public Device {
 public:
  explicit SimulatedTool(const ClosedLoopSettings& settings) : settings_(settings) {}

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override { return {.encoder_step_m = settings_.encoder_step_m}; }
  Holder holder() const noexcept override { return Holder::person; }
  ForceLimits limits() const noexcept override { return settings_.limits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override;
  // Reports the interval between samples, as DeviceEndpoint does.
  DeviceHealth health(double now_s) noexcept override;

  // One step of 50 us towards `aim_m`, which moves at `aim_m_per_s`.
  void advance(double aim_m, double aim_m_per_s, double push_N) noexcept;
  void place(double position_m, double velocity_m_per_s) noexcept;

  double time_s() const noexcept;
  double position_m() const noexcept { return position_m_; }
  double velocity_m_per_s() const noexcept { return velocity_m_per_s_; }
  double force_N() const noexcept { return acting_.force_N; }
  const LoopEnergy& energy() const noexcept { return energy_; }

 private:
  struct Written {
    double force_N = 0.0;
    std::int64_t sampled = 0;  // step of the sample from which it was computed
    std::int64_t due = 0;      // step at which it takes effect
  };

  ClosedLoopSettings settings_;
  std::string name_ = "simulated tool";
  std::int64_t step_ = 0, read_step_ = -1, sample_step_ = 0, newest_sample_ = 0, acted_from_ = 0;
  double position_m_ = -2e-3, velocity_m_per_s_ = 0.0;
  Written acting_;
  std::array<Written, 64> written_{};
  std::size_t first_ = 0, count_ = 0;
  LoopEnergy energy_;
};

// The loop: the tool, the tick, and its timing.
class ClosedLoop {
 public:
  struct Drive {
    double aim_m = 0.0, aim_m_per_s = 0.0;
    double push_N = 0.0;  // a force that does not depend on the position
  };
  using Path = std::function<Drive(double time_s)>;
  using AfterTick = std::function<void(const LoopSnapshot&)>;

  explicit ClosedLoop(const ClosedLoopSettings& settings);
  virtual ~ClosedLoop() = default;

  // Publishes a set of one model, which the next tick takes, with the memory of the motion so far.
  void publish(std::shared_ptr<const ForceModel> model);
  // Runs for `seconds`. The time of `path` starts at 0 with each call. `after_tick` may be empty.
  void run(double seconds, const Path& path, const AfterTick& after_tick = {});

  SimulatedTool& tool() { return tool_; }
  ModelSlot<LiveModels>& slot() { return slot_; }
  std::uint32_t faults() const { return faults_; }

 protected:
  // One tick; tests watch it.
  virtual const LoopSnapshot& tick() { return live_.run(tool_.time_s(), controls_); }

 private:
  SimulatedTool tool_;
  ModelSlot<LiveModels> slot_;
  LiveTick live_;
  MotionHistory history_;
  std::function<std::int64_t(std::int64_t& deadline)> uneven_;
  LoopControls controls_;
  std::int64_t step_ = 0, deadline_ = 0, due_ = 0;
  std::uint32_t id_ = 0, faults_ = 0;
};

// Minimum jerk from `from_m` to `to_m` within `duration_s`, then held.
ClosedLoop::Drive minimum_jerk(double from_m, double to_m, double duration_s, double time_s);

}  // namespace palpate
