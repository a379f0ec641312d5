#include "engine/tick/features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

// Smaller values are set to 0: denormals would slow every later operation.
constexpr double kNothing_N = 1e-30;

// Whether x is not near the kept one.
PALPATE_INLINE bool is_far(double x, double kept) noexcept { return x != kept; }
PALPATE_INLINE bool is_far(const V4& x, const V4& kept) noexcept {
  const auto far = x != kept;
  return (far[0] | far[1] | far[2] | far[3]) != 0;
}

// exp(x (1 + more)), x < 2^47. Makes `kept` the exponential near it and sets `rest` to the quotient of both minus 1:
//   sum_(1 <= n <= 6) r^n / n!,  r = x + x more - kept.at, |r| <= 1/64, so that the rest of the series is below 5e-17.
template <typename Number>
PALPATE_INLINE void split_exponential(const Number& x, double more, KeptExponential<Number>& kept,
                                      Number& rest) noexcept {
  constexpr double kRound = 0x1.8p47;  // the sum of this and a number has the number, rounded to 1/32
  const Number change = x * more;
  const Number near = ((x + change) + kRound) - kRound;
  if (is_far(near, kept.at)) [[unlikely]] {
    V4 value = V4{} + near;
    to_exponential(value);
    kept.at = near;
    kept.value = reinterpret_cast<const Number&>(value);  // all lanes, or the first
  }
  const Number r = (x - kept.at) + change;
  const Number r2 = r * r;
  const Number r4 = r2 * r2;
  rest = (r + r2 * (1.0 / 2 + r * (1.0 / 6))) + r4 * ((1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720));
}

// z' = keep z + gain (g(d') - g(d)). `step_s`: 0 for no step.
PALPATE_INLINE void advance_groups(const BranchLanes::Group* group, std::size_t count, double last_depth_m,
                                   double depth_m, double step_s, V4* value, V4* drive_N,
                                   KeptExponential<double>* slowed, KeptExponential<V4>* kept) noexcept {
  const double middle_m = 0.5 * (last_depth_m + depth_m), per_step = 1.0 / step_s;
  double faster = 1.0, more = 0.0, per_faster = per_step;  // times are divided by faster (1 + more)
  for (std::size_t i = 0; i < count; ++i, ++group) {
    V4 drive;
    evaluate_curve(drive, group->drive, depth_m);
    if (step_s > 0.0) {
      if (group->slows) {
        const double strain = middle_m * group->per_slowing_m;
        split_exponential(group->per_slowing * (strain < 1.0 ? strain : 1.0), 0.0, slowed[i], more);
        faster = slowed[i].value;
        per_faster = per_step / (faster + faster * more);
      }
      V4 rest;
      split_exponential<V4>(-step_s * faster * group->rate_per_s, more, kept[i], rest);
      const V4 keep = kept[i].value + kept[i].value * rest;
      const V4& last = value[i];
      const V4 remaining = keep * (((last < kNothing_N) & (last > -kNothing_N)) ? V4{} : last);
      value[i] = remaining + group->relaxation_time_s * per_faster * (1.0 - keep) * (drive - drive_N[i]);
    }
    drive_N[i] = drive;
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
template <auto loop, typename... Arguments>
[[gnu::noinline]] void call_plain(Arguments... arguments) noexcept {
  loop(arguments...);
}

#ifdef __x86_64__
const bool kWide = __builtin_cpu_supports("avx2") != 0;

template <auto loop, typename... Arguments>
[[gnu::target("avx2")]] void call_wide(Arguments... arguments) noexcept {
  loop(arguments...);
}
#endif

template <auto loop, typename... Arguments>
void call(Arguments... arguments) noexcept {
#ifdef __x86_64__
  if (kWide) return call_wide<loop>(arguments...);
#endif
  call_plain<loop>(arguments...);
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
  const double per_slowing = -slowing, per_slowing_m = 1.0 / slowing_depth_m;
  const bool as_last = !groups_.empty() && groups_.back().per_slowing == per_slowing &&
                       (groups_.back().per_slowing_m == per_slowing_m || slowing == 0.0);
  if (!as_last) count_ = kLanes * groups_.size();
  Group& group = group_of_next(groups_, count_);
  const std::size_t lane = count_ % kLanes;
  group.drive.set(lane, drive);
  group.relaxation_time_s[lane] = relaxation_time_s;
  group.rate_per_s[lane] = std::min(1e9, 1.0 / relaxation_time_s);  // of 1 ns nothing is left after any step
  if (!as_last) group.slows = groups_.size() > 1 || slowing != 0.0;
  group.per_slowing = per_slowing;
  group.per_slowing_m = per_slowing_m;
  return count_++;
}

void BranchLanes::advance(double last_depth_m, double depth_m, double step_s, PartMemory& memory) const noexcept {
  call<advance_groups>(groups_.data(), groups_.size(), last_depth_m, depth_m, step_s, memory.value, memory.drive_N,
                       memory.slowed, memory.kept);
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
