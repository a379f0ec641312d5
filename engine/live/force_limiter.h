// Limits every force before the device gets it. In this order:
//   stop   no force while the sample is stale or impossible, the device has a fault, the dead-man switch is released
//          or the force is not finite
//   ramp   a factor that grows from 0 to 1 over `ramp_s` from the start, and again after each stop
//   clamp  |force| <= largest_N, and less as the motor warms up
//   slew   |change| <= fastest_N_per_s x the time since the last force, so that neither a fault nor a jump is a kick;
//          only a stop may be faster, so that it takes at most `stop_s`
// Thermal model: tau dH/dt = F^2 - H. H is the heat in N^2, c = continuous_N the force that the motor can hold
// permanently. Above kFoldback c^2 the clamp falls, F^2 <= c^2 + (largest^2 - c^2) (1 - H / c^2) / (1 - kFoldback),
// down to c at H = c^2, so that H never exceeds c^2.
// Thread guarantee: one thread at a time; wait-free, never throws.
#pragma once

#include <cstdint>
#include <limits>

namespace palpate {

struct ForceLimits {
  double largest_N = 10.0;          // peak, > 0
  double fastest_N_per_s = 2000.0;  // > 0
  double ramp_s = 0.3;              // >= 0
  // Force that the motor can hold permanently, > 0; infinite: no thermal limit.
  double continuous_N = std::numeric_limits<double>::infinity();
  double thermal_time_s = 10.0;  // tau, > 0
  double stale_after_s = 0.01;   // maximum age of a sample, > 0
  double stop_s = 0.01;          // time to reduce any force to 0; >= 0
};

// The conditions of one force.
struct ForceConditions {
  double sample_age_s = 0.0;  // NaN counts as stale
  bool device_fault = false;
  bool dead_man_released = false;  // a dead-man switch is in use and not held
  bool bad_sample = false;         // the newest sample is impossible; sets no flag
};

// What the limiter did to one force: bits of LoopSnapshot::limiter_flags.
namespace force_limit {
inline constexpr std::uint32_t kNotFinite = 1;  // fault
inline constexpr std::uint32_t kClamped = 2;
inline constexpr std::uint32_t kSlewed = 4;
inline constexpr std::uint32_t kRamping = 8;
inline constexpr std::uint32_t kThermal = 16;      // clamped below largest_N by the thermal model
inline constexpr std::uint32_t kStale = 32;        // fault
inline constexpr std::uint32_t kDeviceFault = 64;  // fault
inline constexpr std::uint32_t kReleased = 128;
}  // namespace force_limit

class ForceLimiter {
 public:
  // H / c^2 from which the clamp decreases, and its initial value, because the earlier temperature is unknown.
  static constexpr double kFoldback = 0.8;

  explicit ForceLimiter(const ForceLimits& limits) noexcept
      : limits_(limits), heat_(kFoldback * limits.continuous_N * limits.continuous_N) {}

  // `commanded_N`: any value; `step_s`: since the last call, clamped to 0 to 10 ms for ramp and slew, so that a stall
  // does not permit a jump. Returns the force to render, finite, and sets `flags`.
  double limit(double commanded_N, double step_s, const ForceConditions& conditions = {}) noexcept;

  std::uint32_t flags() const noexcept { return flags_; }
  double force_N() const noexcept { return force_N_; }
  // H / c^2, dimensionless; 0 without a thermal limit.
  double heat_share() const noexcept;

 private:
  bool stops(double commanded_N, const ForceConditions& conditions) noexcept;
  void warm(double step_s) noexcept;
  double clamp_N() const noexcept;
  void change(double target_N, double most_N) noexcept;

  ForceLimits limits_;
  double share_ = 0.0, force_N_ = 0.0;
  double heat_ = 0.0;  // N^2
  double stop_N_per_s_ = 0.0;
  std::uint32_t flags_ = 0;
  bool stopping_ = false;
};

}  // namespace palpate
