#include "engine/tick/features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

// Smaller values are set to 0: denormals would slow every later operation.
constexpr double kNothing_N = 1e-30;

using Bits [[gnu::vector_size(sizeof(V4))]] = std::int64_t;

// Replaces each x by exp(x), clamped like to_exponential:
//   exp(x) = exp(k / 128) sum_(n <= 5) r^n / n!,  |r| <= 1/256, so that the rest of the series is below 6e-18.
PALPATE_INLINE void to_exponentials(V4* x, std::size_t count, KeptExponential* kept) noexcept {
  constexpr double kRound = 0x1.8p45;  // the sum of this and a number has the number, rounded to 1/128
  Bits moved{};
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = x[i] < -700.0 ? V4{} - 700.0 : x[i];
    x[i] = x[i] > 700.0 ? V4{} + 700.0 : x[i];
    moved |= ((x[i] + kRound) - kRound) != kept[i].at;
  }
  if ((moved[0] | moved[1] | moved[2] | moved[3]) != 0) [[unlikely]] {
    for (std::size_t i = 0; i < count; ++i) {
      kept[i].at = kept[i].value = (x[i] + kRound) - kRound;
      to_exponential(kept[i].value);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const V4 r = x[i] - kept[i].at;
    const V4 r2 = r * r;
    const V4 rest = r + r2 * ((1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120)));
    x[i] = kept[i].value + kept[i].value * rest;
  }
}

// z' = keep z + gain (g(d') - g(d)). `step_s`: 0 for no step.
PALPATE_INLINE void advance_groups(const BranchLanes::Group* group, std::size_t count, bool slows, double last_depth_m,
                                   double depth_m, double step_s, PartMemory* memory) noexcept {
  const double middle_m = 0.5 * (last_depth_m + depth_m), per_step = 1.0 / step_s;
  const bool steps = step_s > 0.0;
  V4 time_s[kMaxLaneGroups], keep[kMaxLaneGroups];
  if (steps && slows) {
    for (std::size_t i = 0; i < count; ++i) {
      const V4 strain = middle_m * group[i].per_slowing_m;
      time_s[i] = group[i].slowing * (strain > 1.0 ? V4{} + 1.0 : strain);
    }
    to_exponentials(time_s, count, memory->slowed);
  }
  for (std::size_t i = 0; steps && i < count; ++i) {
    time_s[i] = slows ? group[i].relaxation_time_s * time_s[i] : group[i].relaxation_time_s;
    keep[i] = -step_s / time_s[i];
  }
  if (steps) to_exponentials(keep, count, memory->kept);
  for (std::size_t i = 0; i < count; ++i) {
    V4 drive;
    evaluate_curve(drive, group[i].drive, depth_m);
    if (steps) {
      const V4& last = memory->value[i];
      const V4 kept = keep[i] * (((last < kNothing_N) & (last > -kNothing_N)) ? V4{} : last);
      memory->value[i] = kept + time_s[i] * (1.0 - keep[i]) * per_step * (drive - memory->drive_N[i]);
    }
    memory->drive_N[i] = drive;
  }
}

// The bends after half a step of creep.
PALPATE_INLINE void creep_on(V4& bend, const V4& creep_per_m2) noexcept {
  V4 root = 1.0 + creep_per_m2 * bend * bend;
  for (std::size_t lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(root[lane]);
  bend /= root;
}

// `step_s`: 0 for no step.
PALPATE_INLINE void bend_groups(const BristleLanes::Group* group, std::size_t count, double last_depth_m,
                                double depth_m, double step_s, V4* bend_m, V4* force_N) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const V4& limit = depth_m > 0.0 ? group[i].limit_m : group[i].air_limit_m;
    V4 bend = bend_m[i];
    if (step_s > 0.0) {
      const V4 creep_per_m2 = step_s * group[i].creep_per_m2_s;
      if (group[i].creeps) creep_on(bend, creep_per_m2);
      bend = bend + depth_m - last_depth_m;
      if (group[i].creeps) creep_on(bend, creep_per_m2);
    }
    bend = bend < -limit ? -limit : (limit < bend ? limit : bend);
    V4 force;
    evaluate_curve(force, group[i].drive, depth_m);
    bend_m[i] = bend;
    force_N[i] = force * bend * group[i].per_threshold_m;
  }
}

// Calls a loop over groups, which is compiled twice, for the baseline and with four lanes to an instruction; the bits
// are the same.
#ifdef __x86_64__
const bool kWide = __builtin_cpu_supports("avx2") != 0;

template <auto loop, typename... Arguments>
[[gnu::target("avx2")]] auto call_wide(Arguments... arguments) noexcept {
  return loop(arguments...);
}
#endif

template <auto loop, typename... Arguments>
auto call(Arguments... arguments) noexcept {
#ifdef __x86_64__
  if (kWide) return call_wide<loop>(arguments...);
#endif
  return loop(arguments...);
}

// The group of the next part after `count` parts.
template <typename Group>
Group& group_of_next(std::vector<Group>& groups, std::size_t count) {
  assert(count < kMaxLaneGroups * kLanes);
  if (count % kLanes == 0) groups.emplace_back();
  return groups.back();
}

}  // namespace

void CurveLanes::set(std::size_t lane, const DriveCurve& drive) noexcept {
  for (std::size_t k = 0; k < kDriveCoefficients; ++k) coefficient_N[k][lane] = drive.coefficient_N[k];
  per_reference[lane] = drive.per_reference_m();
  least_m = std::min(least_m, drive.reference_depth_m);
}

std::size_t BranchLanes::add(const DriveCurve& drive, double relaxation_time_s, double slowing,
                             double slowing_depth_m) {
  Group& group = group_of_next(groups_, count_);
  const std::size_t lane = count_ % kLanes;
  group.drive.set(lane, drive);
  group.relaxation_time_s[lane] = relaxation_time_s;
  group.slowing[lane] = slowing;
  group.per_slowing_m[lane] = 1.0 / slowing_depth_m;
  slows_ = slows_ || slowing != 0.0;
  return count_++;
}

void BranchLanes::advance(double last_depth_m, double depth_m, double step_s, PartMemory& memory) const noexcept {
  call<advance_groups>(groups_.data(), groups_.size(), slows_, last_depth_m, depth_m, step_s, &memory);
}

std::size_t BristleLanes::add(const DriveCurve& drive, double threshold_m, double creep_time_s) {
  Group& group = group_of_next(groups_, count_);
  const std::size_t lane = count_ % kLanes;
  group.drive.set(lane, drive);
  group.per_threshold_m[lane] = 1.0 / threshold_m;
  group.limit_m[lane] = threshold_m;
  if (creep_time_s > 0.0) {
    group.limit_m[lane] = group.air_limit_m[lane] = std::numeric_limits<double>::infinity();
    group.creep_per_m2_s[lane] = 1.0 / (creep_time_s * threshold_m * threshold_m);
    group.creeps = true;
  }
  return count_++;
}

void BristleLanes::advance(double last_depth_m, double depth_m, double step_s, V4* bend_m, V4* force_N) const noexcept {
  call<bend_groups>(groups_.data(), groups_.size(), last_depth_m, depth_m, step_s, bend_m, force_N);
}

}  // namespace palpate
