#include "models/surface/surface_registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "models/surface/common_trend.h"
#include "models/surface/surface_numbers.h"

namespace palpate {
namespace {

// Rows of all recordings together for the common trend, and of each for its onset.
constexpr std::size_t kCommonRows = 4000;
constexpr std::size_t kOnsetRows = 400000;
// Further apart the rows of an approach are too few to tell where force begins: of a
// recording of hours at 1 kHz the first seven minutes tell it.
constexpr double kCoarsestOnset_s = 1.5e-3;
// A shift common to all recordings changes no force of the model, only where its zero
// lies; below what the onset of real specimens tells it stays as recorded.
constexpr double kLeastCommonShift_m = 0.25e-3;
constexpr int kSteps = 12;
constexpr double kConverged_m = 0.2e-6;
constexpr double kLongestStep_m = 0.5e-3;
// The share of what the trend cannot follow that may look like a shift: on pairs of
// virtual recordings, most of materials that are no sum of springs and dashpots, two of
// these shares were never exceeded (worst: a sponge with 0.43 of its misfit).
constexpr double kMisfitShare = 0.35;
constexpr double kNoForceDeviations = 3.0;
constexpr double kNoForceFloor_N = 0.01;

RegisteredMember member_of(const std::vector<SurfaceRow>& rows, double force_noise_N, std::size_t common_rows) {
  RegisteredMember member;
  member.own = estimate_surface(rows, force_noise_N);
  member.rows = thinned_rows(rows, common_rows);
  for (SurfaceRow& row : member.rows) row.force_N -= member.own.force_zero_N;
  return member;
}

struct Consistent {
  std::vector<double> offset_m;
  std::vector<double> error_m;

  // What cannot be told from 0.
  double least_m(std::size_t r) const { return std::max(kLeastOffset_m, kSignificantErrors * error_m[r]); }
};

Consistent align(CommonTrend& trend, std::vector<double> offset_m) {
  double cost = trend.fit(offset_m);
  for (int round = 0; round < kSteps; ++round) {
    trend.gather();
    const std::vector<double> step = trend.step();
    double longest_m = 0.0;
    for (const double value : step) longest_m = std::max(longest_m, std::abs(value));
    double share = std::min(1.0, kLongestStep_m / std::max(longest_m, 1e-12));
    bool better = false;
    for (int halving = 0; halving < 4 && !better && share * longest_m > kConverged_m; ++halving, share *= 0.5) {
      std::vector<double> trial = offset_m;
      for (std::size_t r = 0; r < trial.size(); ++r) trial[r] += share * step[r];
      const double trial_cost = trend.fit(trial);
      better = trial_cost < cost;
      if (!better) continue;
      cost = trial_cost;
      offset_m = trial;
    }
    if (!better) break;
  }
  trend.fit(offset_m);
  trend.gather();
  Consistent result{offset_m, std::vector<double>(offset_m.size(), 0.0)};
  std::vector<std::vector<double>> left_out;
  for (std::size_t fold = 0; fold < CommonTrend::kFolds; ++fold) left_out.push_back(trend.step(fold));
  for (std::size_t r = 0; r < offset_m.size(); ++r) {
    double mean = 0.0;
    double sum = 0.0;
    for (const auto& step : left_out) mean += step[r] / CommonTrend::kFolds;
    for (const auto& step : left_out) sum += (step[r] - mean) * (step[r] - mean);
    const double jackknife_m = std::sqrt(sum * (CommonTrend::kFolds - 1.0) / CommonTrend::kFolds);
    result.error_m[r] = std::hypot(jackknife_m, kMisfitShare * trend.misfit_m(r));
  }
  return result;
}

// Recordings that this shift leaves as recorded.
std::size_t unmoved(const Consistent& consistent, double shift_m) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < consistent.offset_m.size(); ++r) {
    if (std::abs(consistent.offset_m[r] + shift_m) <= consistent.least_m(r)) ++count;
  }
  return count;
}

// Of the shifts within `tolerance_m` of what the onsets say, the one that leaves most
// recordings as they are, and of those the nearest.
double simplest_shift_m(const Consistent& consistent, double onset_m, double tolerance_m) {
  double best_m = onset_m;
  std::size_t most = unmoved(consistent, onset_m);
  for (const double offset_m : consistent.offset_m) {
    if (std::abs(-offset_m - onset_m) > tolerance_m) continue;
    const std::size_t count = unmoved(consistent, -offset_m);
    const bool nearer = count == most && std::abs(-offset_m - onset_m) < std::abs(best_m - onset_m);
    if (count > most || nearer) {
      most = count;
      best_m = -offset_m;
    }
  }
  return best_m;
}

// Adds the shift common to all, from the onsets, weighted by their errors; without
// any the one that moves half of the recordings one way and half the other. Returns
// its error.
double anchor(Consistent& consistent, const std::vector<RegisteredMember>& members) {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t r = 0; r < members.size(); ++r) {
    const double own_error_m = members[r].own.standard_error_m;
    if (!std::isfinite(own_error_m)) continue;
    const double weight = 1.0 / (own_error_m * own_error_m);
    sum += weight * (members[r].own.raw_offset_m - consistent.offset_m[r]);
    weights += weight;
  }
  const double onset_m = weights > 0.0 ? sum / weights : -median_of(consistent.offset_m);
  const double error_m = weights > 0.0 ? std::sqrt(1.0 / weights) : kUnknownError;
  const double shift_m =
      simplest_shift_m(consistent, onset_m, std::max(kSignificantErrors * error_m, kLeastCommonShift_m));
  for (double& offset_m : consistent.offset_m) offset_m += shift_m;
  return error_m;
}

std::vector<RegisteredSurface> registered(const std::vector<RegisteredMember>& members,
                                          const std::vector<FeatureSpec>& features, double force_noise_floor_N) {
  std::vector<RegisteredSurface> surfaces;
  for (const RegisteredMember& member : members) {
    const bool told = members.size() > 1 || (member.own.onset_seen && std::abs(member.own.offset_m) > kLeastCommonShift_m);
    surfaces.push_back({told ? member.own.offset_m : 0.0, member.own.standard_error_m, member.own.force_zero_N});
  }
  if (members.size() < 2) return surfaces;
  std::vector<double> start_m;
  for (const RegisteredMember& member : members) {
    start_m.push_back(std::isfinite(member.own.standard_error_m) ? member.own.raw_offset_m : 0.0);
  }
  CommonTrend trend(members, features, force_noise_floor_N, start_m);
  Consistent consistent = align(trend, start_m);
  const double common_error_m = anchor(consistent, members);
  // One that is certainly elsewhere calls for all: half of a set moved is worse than none.
  const bool any = unmoved(consistent, 0.0) < members.size();
  for (std::size_t r = 0; r < members.size(); ++r) {
    const double offset_m = consistent.offset_m[r];
    surfaces[r].offset_m = any && std::abs(offset_m) > kLeastOffset_m ? offset_m : 0.0;
    surfaces[r].standard_error_m = std::hypot(consistent.error_m[r], common_error_m);
  }
  return surfaces;
}

}  // namespace

Result<std::vector<RegisteredSurface>> register_surfaces(MotionSource& source, const std::vector<FeatureSpec>& features,
                                                         const FitControl& control, double fraction) {
  std::vector<RegisteredMember> members;
  GrowingStride rows(kOnsetRows, kCoarsestOnset_s);
  std::vector<std::vector<SurfaceRow>> recordings;
  const Status status = source.for_each([&](const MotionRow& row) {
    if (row.first && row.recording > 0) {
      recordings.push_back(rows.rows());
      rows = GrowingStride(kOnsetRows, kCoarsestOnset_s);
    }
    rows.add({row.sample, row.motion, row.force_N});
    return true;
  }, control, fraction);
  if (!status) return status.error();
  recordings.push_back(rows.rows());
  const std::size_t share = std::max<std::size_t>(200, kCommonRows / recordings.size());
  for (const auto& recording : recordings) members.push_back(member_of(recording, source.force_noise_N(), share));
  if (!control.may_continue(fraction)) return interrupted();
  return registered(members, features, std::max(kNoForceFloor_N, kNoForceDeviations * source.force_noise_N()));
}

std::vector<RowCorrection> corrections_of(const std::vector<RegisteredSurface>& surfaces) {
  std::vector<RowCorrection> corrections;
  for (const RegisteredSurface& surface : surfaces) corrections.push_back({surface.offset_m, surface.force_zero_N});
  return corrections;
}

}  // namespace palpate
