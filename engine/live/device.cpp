#include "engine/live/device.h"

namespace palpate {
namespace {

// Ten ticks. A longer step is a stall, after which the force changes as after 10 ms.
constexpr double kLongestStep_s = 0.01;

}  // namespace

double ForceLimiter::heat_share() const noexcept {
  const double budget = limits_.continuous_N * limits_.continuous_N;
  return std::isfinite(budget) ? heat_ / budget : 0.0;
}

// The last force acted for all of `step_s`, a stall included. Backward Euler is stable for any step.
void ForceLimiter::warm(double step_s) noexcept {
  if (!std::isfinite(limits_.continuous_N) || !(step_s > 0.0)) return;
  const double share = std::isfinite(step_s) ? step_s / (limits_.thermal_time_s + step_s) : 1.0;
  heat_ += share * (force_N_ * force_N_ - heat_);
}

double ForceLimiter::clamp_N() const noexcept {
  const double lasting_N = limits_.continuous_N;
  if (!(lasting_N < limits_.largest_N)) return limits_.largest_N;
  const double left = std::clamp((1.0 - heat_share()) / (1.0 - kFoldback), 0.0, 1.0);
  if (left == 1.0) return limits_.largest_N;
  return std::sqrt(lasting_N * lasting_N + left * (limits_.largest_N * limits_.largest_N - lasting_N * lasting_N));
}

bool ForceLimiter::stops(double commanded_N, const ForceConditions& conditions) noexcept {
  if (!std::isfinite(commanded_N)) flags_ |= force_limit::kNotFinite;
  // The comparison is false for NaN, which therefore counts as stale.
  if (!(conditions.sample_age_s <= limits_.stale_after_s)) flags_ |= force_limit::kStale;
  if (conditions.device_fault) flags_ |= force_limit::kDeviceFault;
  if (conditions.dead_man_released) flags_ |= force_limit::kReleased;
  return flags_ != 0 || conditions.bad_sample;
}

void ForceLimiter::change(double target_N, double most_N) noexcept {
  const double change_N = std::clamp(target_N - force_N_, -most_N, most_N);
  const bool slewed = change_N != target_N - force_N_;
  if (slewed) flags_ |= force_limit::kSlewed;
  force_N_ = slewed ? force_N_ + change_N : target_N;
}

double ForceLimiter::limit(double commanded_N, double step_s, const ForceConditions& conditions) noexcept {
  // The comparison is false for NaN, which therefore counts as a step of 0.
  const double step = step_s > 0.0 ? std::min(step_s, kLongestStep_s) : 0.0;
  warm(step_s);
  flags_ = 0;
  if (stops(commanded_N, conditions)) {
    if (!stopping_) {
      stop_N_per_s_ = std::max(limits_.fastest_N_per_s, limits_.stop_s > 0.0 ? std::abs(force_N_) / limits_.stop_s
                                                                             : std::numeric_limits<double>::infinity());
    }
    stopping_ = true;
    share_ = 0.0;
    change(0.0, step > 0.0 ? stop_N_per_s_ * step : 0.0);
    return force_N_;
  }
  stopping_ = false;
  if (share_ < 1.0) flags_ |= force_limit::kRamping;
  const double ramped_N = commanded_N * share_;
  share_ = limits_.ramp_s > 0.0 ? std::min(1.0, share_ + step / limits_.ramp_s) : 1.0;
  const double most_N = clamp_N(), clamped_N = std::clamp(ramped_N, -most_N, most_N);
  if (clamped_N != ramped_N) flags_ |= force_limit::kClamped;
  if (clamped_N != ramped_N && most_N < limits_.largest_N) flags_ |= force_limit::kThermal;
  change(clamped_N, limits_.fastest_N_per_s * step);
  return force_N_;
}

}  // namespace palpate
