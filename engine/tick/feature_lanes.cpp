#include "engine/tick/feature_lanes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/tick/exponential.h"
#include "engine/tick/features.h"

namespace palpate {
namespace {

// A filter at rest decays to zero, not into denormals, which would slow every later
// operation on it.
constexpr double kNothing_N = 1e-30;
PALPATE_INLINE void curve_at(V4& value, const CurveLanes& curve, double depth_m) noexcept {
  const auto* knots = curve.has_knots ? &curve.knot_N : nullptr;
  const V4 u = depth_m / curve.reference_depth_m;
  const V4 inside = u > 1.0 ? V4{} + 1.0 : u;
  rising_value(value, curve.coefficient_N, knots, inside);
  if (depth_m > curve.least_reference_m) [[unlikely]] {
    V4 slope;
    slope_at_end(slope, curve.coefficient_N, knots);
    value = u > 1.0 ? value + slope * (u - 1.0) : value;
  }
}

PALPATE_INLINE void step_of(V4& keep, V4& gain, const V4& time_s, double step_s, double per_step) noexcept {
  keep = -step_s / time_s;
  to_exponential(keep);
  gain = time_s * (1.0 - keep) * per_step;
}

PALPATE_INLINE void prepare_groups(BranchLanes::Group* group, std::size_t count, double step_s) noexcept {
  const double per_step = 1.0 / step_s;
  for (std::size_t i = 0; i < count; ++i) {
    step_of(group[i].keep, group[i].gain, group[i].relaxation_time_s * group[i].clock, step_s, per_step);
  }
}

using BranchStates = BranchLanes::States;

PALPATE_INLINE double held_by_groups(const BranchLanes::Group* group, std::size_t count, double surface_m,
                                     const BranchStates& from, BranchStates& to) noexcept {
  V4 sum{};
  for (std::size_t i = 0; i < count; ++i) {
    V4 drive;
    curve_at(drive, group[i].drive, surface_m);
    const V4& last = from.force_N[i];
    const V4 kept = group[i].keep * (((last < kNothing_N) & (last > -kNothing_N)) ? V4{} : last);
    to.force_N[i] = kept + group[i].gain * (drive - from.drive_N[i]);
    to.drive_N[i] = drive;
    sum += to.force_N[i];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// What half a step of creep leaves of the bends.
PALPATE_INLINE void creep_on(V4& bend, const V4& creep_per_m2_s, double step_s) noexcept {
  const V4 squared = 1.0 + step_s * creep_per_m2_s * bend * bend;
  for (std::size_t lane = 0; lane < kLanes; ++lane) bend[lane] /= std::sqrt(squared[lane]);
}

// `step_s`: 0 for no step.
PALPATE_INLINE void bend_groups(BristleLanes::Group* group, std::size_t count, double last_depth_m, double depth_m,
                                double step_s, V4* force_N) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const V4& limit = depth_m > 0.0 ? group[i].limit_m : group[i].air_limit_m;
    V4 bend = group[i].bend_m;
    if (step_s > 0.0) {
      if (group[i].creeps) creep_on(bend, group[i].creep_per_m2_s, step_s);
      bend = bend + depth_m - last_depth_m;
      if (group[i].creeps) creep_on(bend, group[i].creep_per_m2_s, step_s);
    }
    bend = bend < -limit ? -limit : (limit < bend ? limit : bend);
    V4 force;
    curve_at(force, group[i].drive, depth_m);
    group[i].bend_m = bend;
    force_N[i] = force * bend / group[i].threshold_m;
  }
}

// Plainly, and with four lanes to an instruction: the same bits.
#define PALPATE_LANE_LOOPS(attribute, suffix)                                                                      \
  attribute void prepare_##suffix(BranchLanes::Group* group, std::size_t count, double step_s) noexcept {          \
    prepare_groups(group, count, step_s);                                                                          \
  }                                                                                                                \
  attribute double held_##suffix(const BranchLanes::Group* group, std::size_t count, double surface_m,             \
                                 const BranchStates& from, BranchStates& to) noexcept {                            \
    return held_by_groups(group, count, surface_m, from, to);                                                      \
  }                                                                                                                \
  attribute void bend_##suffix(BristleLanes::Group* group, std::size_t count, double last_depth_m, double depth_m, \
                               double step_s, V4* force_N) noexcept {                                              \
    bend_groups(group, count, last_depth_m, depth_m, step_s, force_N);                                             \
  }

PALPATE_LANE_LOOPS(, plain)
#ifdef __x86_64__
PALPATE_LANE_LOOPS([[gnu::target("avx2")]], wide)
const bool kWide = has_wide_lanes();
const auto kPrepare = kWide ? &prepare_wide : &prepare_plain;
const auto kHeld = kWide ? &held_wide : &held_plain;
const auto kBend = kWide ? &bend_wide : &bend_plain;
#else
constexpr auto kPrepare = &prepare_plain;
constexpr auto kHeld = &held_plain;
constexpr auto kBend = &bend_plain;
#endif
#undef PALPATE_LANE_LOOPS

// The group of a part that comes after `count`.
template <typename Group>
Group& group_of_next(std::vector<Group>& groups, std::size_t count) {
  assert(count < kMaxLaneGroups * kLanes);
  if (count % kLanes == 0) groups.emplace_back();
  return groups.back();
}

}  // namespace

BranchStep branch_step(double relaxation_time_s, double step_s) noexcept {
  V4 keep;
  V4 gain;
  step_of(keep, gain, V4{relaxation_time_s, 1.0, 1.0, 1.0}, step_s, 1.0 / step_s);
  return {keep[0], gain[0]};
}

void CurveLanes::set(std::size_t lane, const DriveCurve& drive) noexcept {
  for (std::size_t k = 0; k < kDriveCoefficients; ++k) coefficient_N[k][lane] = drive.coefficient_N[k];
  reference_depth_m[lane] = drive.reference_depth_m;
  least_reference_m = std::min(least_reference_m, drive.reference_depth_m);
  if (!drive.has_knots) return;
  has_knots = true;
  for (std::size_t k = 0; k < kDriveKnots; ++k) knot_N[k][lane] = drive.knot_N[k];
}

std::size_t BranchLanes::add(const DriveCurve& drive, double relaxation_time_s) {
  Group& group = group_of_next(groups_, count_);
  group.drive.set(count_ % kLanes, drive);
  group.relaxation_time_s[count_ % kLanes] = relaxation_time_s;
  return count_++;
}

void BranchLanes::prepare(double step_s) noexcept {
  kPrepare(groups_.data(), groups_.size(), step_s);
  held_at_m_ = std::numeric_limits<double>::quiet_NaN();
}

double BranchLanes::held_N(double surface_m) noexcept {
  held_at_m_ = surface_m;
  return kHeld(groups_.data(), groups_.size(), surface_m, states_[now_], states_[1 - now_]);
}

void BranchLanes::advance(double surface_m) noexcept {
  if (!(held_at_m_ == surface_m)) held_N(surface_m);
  now_ = 1 - now_;
}

void BranchLanes::stay(double surface_m, bool at_rest) noexcept {
  held_N(surface_m);
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    states_[now_].drive_N[i] = states_[1 - now_].drive_N[i];
    if (at_rest) states_[now_].force_N[i] = V4{};
  }
}

double BranchLanes::force_N(std::size_t place, std::size_t count) const noexcept {
  double sum = 0.0;
  for (std::size_t i = place; i < place + count; ++i) sum += states_[now_].force_N[i / kLanes][i % kLanes];
  return sum;
}

void BranchLanes::adopt(std::size_t place, const BranchLanes& from, std::size_t other) noexcept {
  const States& old = from.states_[from.now_];
  states_[now_].force_N[place / kLanes][place % kLanes] = old.force_N[other / kLanes][other % kLanes];
  states_[now_].drive_N[place / kLanes][place % kLanes] = old.drive_N[other / kLanes][other % kLanes];
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

void BristleLanes::advance(double last_depth_m, double depth_m, double step_s) noexcept {
  kBend(groups_.data(), groups_.size(), last_depth_m, depth_m, step_s, force_N_);
}

void BristleLanes::stay(double depth_m) noexcept {
  kBend(groups_.data(), groups_.size(), depth_m, depth_m, 0.0, force_N_);
}

void BristleLanes::release() noexcept {
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    groups_[i].bend_m = V4{};
    force_N_[i] = V4{};
  }
}

double BristleLanes::force_N(std::size_t place, std::size_t count) const noexcept {
  double sum = 0.0;
  for (std::size_t i = place; i < place + count; ++i) sum += force_N_[i / kLanes][i % kLanes];
  return sum;
}

void BristleLanes::adopt(std::size_t place, const BristleLanes& from, std::size_t other) noexcept {
  groups_[place / kLanes].bend_m[place % kLanes] = from.groups_[other / kLanes].bend_m[other % kLanes];
}

}  // namespace palpate
