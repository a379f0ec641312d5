#include "engine/tick/feature_lanes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

// Smaller values are set to 0: denormals would slow every later operation.
constexpr double kNothing_N = 1e-30;

// z' = keep z + gain (g(d') - g(d)). `step_s`: 0 for no step.
PALPATE_INLINE void advance_groups(const BranchLanes::Group* group, std::size_t count, double last_depth_m,
                                   double depth_m, double step_s, PartMemory* memory) noexcept {
  const double middle_m = 0.5 * (last_depth_m + depth_m);
  const double per_step = 1.0 / step_s;
  for (std::size_t i = 0; i < count; ++i) {
    V4 drive;
    evaluate_curve(drive, group[i].drive, depth_m);
    if (step_s > 0.0) {
      V4 time_s = group[i].relaxation_time_s;
      if (group[i].slows) {
        const V4 strain = middle_m / group[i].slowing_depth_m;
        V4 clock = group[i].slowing * (strain > 1.0 ? V4{} + 1.0 : strain);
        to_exponential(clock);
        time_s *= clock;
      }
      V4 keep = -step_s / time_s;
      to_exponential(keep);
      const V4 gain = time_s * (1.0 - keep) * per_step;
      const V4& last = memory->value[i];
      const V4 kept = keep * (((last < kNothing_N) & (last > -kNothing_N)) ? V4{} : last);
      memory->value[i] = kept + gain * (drive - memory->drive_N[i]);
    }
    memory->drive_N[i] = drive;
  }
}

// The bends after half a step of creep.
PALPATE_INLINE void creep_on(V4& bend, const V4& creep_per_m2_s, double step_s) noexcept {
  const V4 squared = 1.0 + step_s * creep_per_m2_s * bend * bend;
  for (std::size_t lane = 0; lane < kLanes; ++lane) bend[lane] /= std::sqrt(squared[lane]);
}

// `step_s`: 0 for no step.
PALPATE_INLINE void bend_groups(const BristleLanes::Group* group, std::size_t count, double last_depth_m,
                                double depth_m, double step_s, V4* bend_m, V4* force_N) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const V4& limit = depth_m > 0.0 ? group[i].limit_m : group[i].air_limit_m;
    V4 bend = bend_m[i];
    if (step_s > 0.0) {
      if (group[i].creeps) creep_on(bend, group[i].creep_per_m2_s, step_s);
      bend = bend + depth_m - last_depth_m;
      if (group[i].creeps) creep_on(bend, group[i].creep_per_m2_s, step_s);
    }
    bend = bend < -limit ? -limit : (limit < bend ? limit : bend);
    V4 force;
    evaluate_curve(force, group[i].drive, depth_m);
    bend_m[i] = bend;
    force_N[i] = force * bend / group[i].threshold_m;
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

double sum_of_lanes(const V4* value, std::size_t first, std::size_t count) noexcept {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) sum += value[i / kLanes][i % kLanes];
  return sum;
}

void CurveLanes::set(std::size_t lane, const DriveCurve& drive) noexcept {
  for (std::size_t k = 0; k < kDriveCoefficients; ++k) coefficient_N[k][lane] = drive.coefficient_N[k];
  reference_depth_m[lane] = drive.reference_depth_m;
  least_m = std::min(least_m, drive.reference_depth_m);
}

std::size_t BranchLanes::add(const DriveCurve& drive, double relaxation_time_s, double slowing,
                             double slowing_depth_m) {
  Group& group = group_of_next(groups_, count_);
  const std::size_t lane = count_ % kLanes;
  group.drive.set(lane, drive);
  group.relaxation_time_s[lane] = relaxation_time_s;
  group.slowing[lane] = slowing;
  group.slowing_depth_m[lane] = slowing_depth_m;
  group.slows = group.slows || slowing != 0.0;
  return count_++;
}

void BranchLanes::advance(double last_depth_m, double depth_m, double step_s, PartMemory& memory) const noexcept {
  call<advance_groups>(groups_.data(), groups_.size(), last_depth_m, depth_m, step_s, &memory);
}

std::size_t BristleLanes::add(const DriveCurve& drive, double threshold_m, double creep_time_s) {
  Group& group = group_of_next(groups_, count_);
  const std::size_t lane = count_ % kLanes;
  group.drive.set(lane, drive);
  group.threshold_m[lane] = threshold_m;
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
