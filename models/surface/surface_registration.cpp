#include "models/surface/surface_registration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/tick/sensor_identification.h"
#include "models/recordings/force_curve.h"
#include "models/recordings/force_lag.h"
#include "models/recordings/surface_estimate.h"

namespace palpate {
namespace {

// A share of the rows with a certain force: if more of them are outside of the surface, it is moved outwards.
constexpr double kOuterShare = 0.005;
constexpr double kOuterRange = 0.01;  // of the largest force: sensors drift

struct Member {
  std::vector<SurfaceRow> rows;  // thinned, without the force zero
  SurfaceEstimate own;
  double range_m = 0.0;     // of the positions
  OffsetEstimate offset;    // as estimated
  RecordingSurface result;  // with the offset from the common surface
};

// The common lag; 0 if less than half of the recordings identify one, or if they disagree.
double common_lag_s(const std::vector<RecordingOffsets>& recordings) {
  std::vector<double> lags_s;
  for (const RecordingOffsets& one : recordings) {
    if (one.lag.at != 0.0) lags_s.push_back(one.lag.at);
  }
  if (lags_s.empty() || 2 * lags_s.size() < recordings.size()) return 0.0;
  const double lag_s = median_of(lags_s);
  const bool agree = std::all_of(lags_s.begin(), lags_s.end(),
                                 [&](double one_s) { return std::abs(one_s - lag_s) <= kLagAccuracy_s; });
  return agree ? lag_s : 0.0;
}

std::vector<ForceAtPosition> forces_of(const Member& member) {
  std::vector<ForceAtPosition> forces;
  for (const SurfaceRow& row : member.rows) forces.push_back({row.motion.position_m, row.force_N});
  return forces;
}

// Surfaces that differ by less count as equal.
constexpr double kLeastSurface_m = 0.5 * kWidestSurface_m;

OffsetEstimate identified(double at_m, double standard_error_m) {
  OffsetEstimate offset;
  offset.identified = true;
  offset.at = at_m;
  offset.standard_error = standard_error_m;
  return offset;
}

// The offset of `member` to the reference: the difference of their surfaces, where both are identified, otherwise the
// shift between their forces.
OffsetEstimate offset_of(const Member& member, const Member& reference, const JndLine& jnd) {
  if (&member == &reference) return identified(0.0, 0.0);
  if (member.own.identified() && reference.own.identified()) {
    return identified(member.own.raw_offset_m - reference.own.raw_offset_m,
                      std::hypot(member.own.standard_error_m, reference.own.standard_error_m));
  }
  const std::vector<ForceAtPosition> a = forces_of(reference);
  const std::vector<ForceAtPosition> b = forces_of(member);
  const double bin_m = common_bin_m(a, b);
  if (!(bin_m > 0.0)) return {};
  const auto shift_m = find_shift_m(ForceCurve(a, bin_m), ForceCurve(b, bin_m), jnd);
  return shift_m ? identified(*shift_m, bin_m / 8.0) : OffsetEstimate{};  // half a step of the search
}

// The identified offsets in the middle of all: twice the same, if their number is odd.
std::pair<double, double> middle_offsets_m(const std::vector<Member>& members) {
  std::vector<double> offsets_m;
  for (const Member& member : members) {
    if (member.offset.identified) offsets_m.push_back(member.offset.at);
  }
  std::ranges::sort(offsets_m);
  return {offsets_m[(offsets_m.size() - 1) / 2], offsets_m[offsets_m.size() / 2]};
}

bool unmoved(const Member& member, const std::pair<double, double>& middle_m) {
  return std::max(std::abs(member.offset.at - middle_m.first), std::abs(member.offset.at - middle_m.second)) <=
         std::max(kLeastSurface_m, kSignificantErrors * member.offset.standard_error);
}

// The weighted mean of the onsets of the recordings after their offsets; 0 if no onset is identified, or if the mean
// does not differ significantly from 0.
double common_surface_m(const std::vector<Member>& members) {
  double sum = 0.0;
  double weights = 0.0;
  for (const Member& member : members) {
    const SurfaceEstimate& own = member.own;
    if (!own.identified()) continue;
    const double weight = 1.0 / (own.standard_error_m * own.standard_error_m);
    sum += weight * (own.raw_offset_m - member.result.offset_m);
    weights += weight;
  }
  if (!(weights > 0.0)) return 0.0;
  const double at_m = sum / weights;
  return std::abs(at_m) > std::max(kLeastSurface_m, kSignificantErrors / std::sqrt(weights)) ? at_m : 0.0;
}

// The outermost position with a certain force, after the offsets, if more than kOuterShare of these rows are outside
// of `surface_m`; otherwise `surface_m`.
double outermost_contact_m(const std::vector<Member>& members, double force_noise_N, double surface_m) {
  double largest_N = 0.0;
  for (const Member& member : members) {
    for (const SurfaceRow& row : member.rows) largest_N = std::max(largest_N, std::abs(row.force_N));
  }
  const double least_N = std::max(certain_force_N(force_noise_N), kOuterRange * largest_N);
  std::vector<double> positions_m;
  for (const Member& member : members) {
    if (member.own.air.tool_mass_kg > 0.0) return surface_m;
    for (const SurfaceRow& row : member.rows) {
      const bool air = member.own.air.found && row.motion.position_m < member.own.air.inner_end_m;
      if (air || std::abs(row.force_N) <= least_N) continue;
      positions_m.push_back(row.motion.position_m - member.result.offset_m);
    }
  }
  const auto few = static_cast<std::size_t>(kOuterShare * static_cast<double>(positions_m.size()));
  if (positions_m.size() <= few + 1) return surface_m;
  const auto at = positions_m.begin() + static_cast<std::ptrdiff_t>(few);
  std::nth_element(positions_m.begin(), at, positions_m.end());
  return *at < surface_m ? *std::min_element(positions_m.begin(), at + 1) : surface_m;
}

RegisteredSurfaces registered(std::vector<Member> members, double force_noise_N, const JndLine& jnd) {
  const bool zeros = std::all_of(members.begin(), members.end(), [](const Member& one) { return one.own.air.found; });
  for (Member& member : members) {
    if (!zeros) member.own.force_zero_N = 0.0;
    for (SurfaceRow& row : member.rows) row.force_N -= member.own.force_zero_N;
  }
  RegisteredSurfaces result;
  const Member& reference = *std::ranges::max_element(
      members, {}, [](const Member& one) { return std::pair(one.own.identified(), one.range_m); });
  for (Member& member : members) member.offset = offset_of(member, reference, jnd);
  const std::pair<double, double> middle_m = middle_offsets_m(members);
  const double median_m = 0.5 * (middle_m.first + middle_m.second);
  for (Member& member : members) {
    member.result.force_zero_N = member.own.force_zero_N;
    member.result.standard_error_m = members.size() == 1 ? member.own.standard_error_m : member.offset.standard_error;
    if (member.offset.identified && !unmoved(member, middle_m)) member.result.offset_m = member.offset.at - median_m;
    result.recordings.push_back(member.result);
  }
  result.surface_position_m = outermost_contact_m(members, force_noise_N, common_surface_m(members));
  // The members' offsets are in the result; without them the recordings are as recorded.
  for (Member& member : members) member.result.offset_m = 0.0;
  result.unmoved_surface_position_m = outermost_contact_m(members, force_noise_N, common_surface_m(members));
  return result;
}

}  // namespace

Result<RegisteredSurfaces> register_surfaces(MotionSource& source, const JndLine& jnd, const FitControl& control) {
  if (const Status status = source.load(control); !status) return status.error();
  std::vector<std::vector<SurfaceRow>> recordings;
  std::vector<RecordingOffsets> offsets;
  for (const auto& recording : source.recordings()) {
    GrowingStride kept(kOnsetRows, kCoarsestOnset_s);
    for (const MotionRow& row : recording.rows) kept.add(row);
    recordings.push_back(kept.rows());
    offsets.push_back(recording.prepared->offsets);
    if (!control.may_continue(0.0)) return interrupted();
  }
  const double lag_s = common_lag_s(offsets);
  std::vector<Member> members;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<SurfaceRow>& rows = recordings[r];
    if (lag_s != 0.0) {
      // A recording shorter than the lag stays as it is.
      if (auto moved = without_lag(rows, lag_s); !moved.empty()) rows = std::move(moved);
    }
    const bool same_lag = offsets[r].lag.at == lag_s;
    Member& member = members.emplace_back();
    member.own = same_lag ? offsets[r].surface : estimate_surface(rows, source.force_noise_N());
    member.rows = thinned_rows(rows, kSearchRows);
    const auto [low_m, high_m] = position_range_m(rows);
    member.range_m = high_m - low_m;
    member.result.name = source.recordings()[r].name;
    member.result.lag_s = lag_s;
    member.result.content_hash = source.recordings()[r].hash;
  }
  if (!control.may_continue(0.0)) return interrupted();
  RegisteredSurfaces result = registered(std::move(members), source.force_noise_N(), jnd);
  if (!control.may_continue(0.0)) return interrupted();
  return result;
}

}  // namespace palpate
