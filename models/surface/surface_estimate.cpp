#include "models/surface/surface_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/tick/sensor_identification.h"
#include "models/surface/surface_onset.h"
#include "models/surface/surface_numbers.h"

namespace palpate {
namespace {

// Longer recordings are thinned: 30 minutes at 1 kHz keep every row.
constexpr std::size_t kEstimateRows = 2000000;
// The first guess of where force begins: five deviations of the noise, 20 mN.
constexpr double kOnsetDeviations = 5.0;
constexpr double kOnsetFloor_N = 0.02;
constexpr double kAirMargin_m = 0.5e-3;
constexpr std::size_t kLeastAirRows = 10;
// Force zeros smaller than this are none: 1.5 % of the JND at rest.
constexpr double kLeastZero_N = 1e-3;

std::vector<double> forces_outside_N(const std::vector<SurfaceRow>& rows, double below_m) {
  std::vector<double> forces;
  for (const SurfaceRow& row : rows) {
    if (row.motion.position_m < below_m) forces.push_back(row.force_N);
  }
  return forces;
}

// The force where the tool is farthest out: the first guess of the zero.
double outermost_force_N(const std::vector<SurfaceRow>& rows) {
  std::vector<double> positions;
  for (const SurfaceRow& row : rows) positions.push_back(row.motion.position_m);
  const auto at = positions.begin() + static_cast<std::ptrdiff_t>(positions.size() / 20);
  std::nth_element(positions.begin(), at, positions.end());
  return median_of(forces_outside_N(rows, *at + 1e-9));
}

void estimate_zero(SurfaceEstimate& estimate, const std::vector<double>& air_N, std::size_t rows) {
  estimate.free_air_share = static_cast<double>(air_N.size()) / static_cast<double>(rows);
  estimate.force_zero_error_N = kUnknownError;
  estimate.force_zero_N = estimate.force_zero_drift_N = 0.0;
  if (air_N.size() < kLeastAirRows) return;
  const double middle_N = median_of(air_N);
  double squares = 0.0;
  double mean_N = 0.0;
  for (const double force_N : air_N) mean_N += (force_N - middle_N) / static_cast<double>(air_N.size());
  for (const double force_N : air_N) squares += (force_N - middle_N) * (force_N - middle_N);
  const double count = static_cast<double>(air_N.size());
  // A quantised force has a median on one of its steps; the mean near it has not.
  const double spread_N = std::sqrt(squares / count);
  if (std::abs(mean_N) < spread_N) estimate.force_zero_N = middle_N + mean_N;
  else estimate.force_zero_N = middle_N;
  estimate.force_zero_error_N = spread_N / std::sqrt(count);
  const auto third = static_cast<std::ptrdiff_t>(air_N.size() / 3);
  estimate.force_zero_drift_N =
      median_of({air_N.end() - third, air_N.end()}) - median_of({air_N.begin(), air_N.begin() + third});
}

void estimate_drift(SurfaceEstimate& estimate, const std::vector<SurfaceRow>& rows, const std::vector<Touch>& touches,
                    double force_noise_N) {
  estimate.offset_drift_error_m = kUnknownError;
  if (touches.size() < 2) return;
  const Onset first = find_onset(rows, {touches.front()}, estimate.force_zero_N, force_noise_N);
  const Onset last = find_onset(rows, {touches.back()}, estimate.force_zero_N, force_noise_N);
  estimate.offset_drift_error_m = std::hypot(first.standard_error_m, last.standard_error_m);
  const double drift_m = last.at_m - first.at_m;
  if (std::abs(drift_m) > kSignificantErrors * estimate.offset_drift_error_m) estimate.offset_drift_m = drift_m;
}

}  // namespace

SurfaceEstimate estimate_surface(const std::vector<SurfaceRow>& rows, double force_noise_N) {
  SurfaceEstimate estimate;
  estimate.standard_error_m = estimate.force_zero_error_N = estimate.offset_drift_error_m = kUnknownError;
  if (rows.size() < kLeastAirRows) return estimate;
  const double threshold_N = std::max(kOnsetFloor_N, kOnsetDeviations * force_noise_N);
  auto touches = touches_at_rest(rows, outermost_force_N(rows), threshold_N);
  for (int round = 0; round < 2 && !touches.empty(); ++round) {
    estimate_zero(estimate, forces_outside_N(rows, touches.front().first_force_m - kAirMargin_m), rows.size());
    touches = touches_at_rest(rows, estimate.force_zero_N, threshold_N);
  }
  if (touches.empty()) return estimate;
  // A zero that drifts by more than it is off is not known either.
  const double least_N = std::max({kLeastZero_N, kSignificantErrors * estimate.force_zero_error_N,
                                   std::abs(estimate.force_zero_drift_N)});
  if (std::abs(estimate.force_zero_N) < least_N) estimate.force_zero_N = 0.0;

  const Onset onset = find_onset(rows, touches, estimate.force_zero_N, force_noise_N);
  estimate.touches = static_cast<int>(touches.size());
  estimate.raw_offset_m = onset.at_m;
  estimate.standard_error_m = onset.standard_error_m;
  estimate.onset_seen = onset.seen;
  const bool significant = std::abs(onset.at_m) > std::max(kLeastOffset_m, kSignificantErrors * onset.standard_error_m);
  if (significant) estimate.offset_m = onset.at_m;
  estimate_drift(estimate, rows, touches, force_noise_N);
  return estimate;
}

SurfaceEstimate estimate_surface(const Recording& recording) {
  return estimate_surface(thinned_rows(recording, kEstimateRows),
                          identify_force_noise_N(recording.rows.data(), recording.rows.size()));
}

}  // namespace palpate
