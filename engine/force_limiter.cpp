#include "engine/force_limiter.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Ten ticks: longer is a stall, after which the force moves as after 10 ms.
constexpr double kLongestStep_s = 0.01;

}  // namespace

double ForceLimiter::limit(double wanted_N, double step_s) noexcept {
  // The comparison is false for a NaN, which so counts as no time at all.
  const double step = step_s > 0.0 ? std::min(step_s, kLongestStep_s) : 0.0;
  flags_ = 0;
  if (!std::isfinite(wanted_N)) {
    flags_ |= force_limit::kNotFinite;
    wanted_N = 0.0;
    share_ = 0.0;
  } else {
    if (share_ < 1.0) flags_ |= force_limit::kRamping;
    wanted_N *= share_;
    share_ = limits_.ramp_s > 0.0 ? std::min(1.0, share_ + step / limits_.ramp_s) : 1.0;
  }
  const double clamped_N = std::clamp(wanted_N, -limits_.largest_N, limits_.largest_N);
  if (clamped_N != wanted_N) flags_ |= force_limit::kClamped;
  const double most_N = limits_.fastest_N_per_s * step;
  const double change_N = std::clamp(clamped_N - force_N_, -most_N, most_N);
  const bool slewed = change_N != clamped_N - force_N_;
  if (slewed) flags_ |= force_limit::kSlewed;
  force_N_ = slewed ? force_N_ + change_N : clamped_N;
  return force_N_;
}

}  // namespace palpate
