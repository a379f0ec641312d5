#include "models/samples/surface_estimate.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/sensor_identification.h"
#include "models/samples/profile_search.h"
#include "models/samples/surface_onset.h"

namespace palpate {
namespace {

// Longer recordings are thinned: 30 minutes at 1 kHz keep every row.
constexpr std::size_t kEstimateRows = 2000000;
// Force begins above five standard deviations of the noise, at least 20 mN.
constexpr double kOnsetDeviations = 5.0;
constexpr double kOnsetFloor_N = 0.02;
// A smaller force zero counts as 0: 1.5 % of the JND at 0 N.
constexpr double kLeastZero_N = 1e-3;

void estimate_drift(SurfaceEstimate& estimate, const std::vector<Sample>& rows, const std::vector<Touch>& touches,
                    double zero_N, double force_noise_N) {
  if (touches.size() < 2) return;
  const Onset first = find_onset(rows, {touches.front()}, zero_N, force_noise_N);
  const Onset last = find_onset(rows, {touches.back()}, zero_N, force_noise_N);
  estimate.offset_drift_error_m =
      std::hypot(std::hypot(first.standard_error_m, last.standard_error_m), std::hypot(first.misfit_m, last.misfit_m));
  const double drift_m = last.at_m - first.at_m;
  if (std::abs(drift_m) > kSignificantErrors * estimate.offset_drift_error_m) estimate.offset_drift_m = drift_m;
}

}  // namespace

SurfaceEstimate estimate_surface(const std::vector<Sample>& rows, double force_noise_N) {
  SurfaceEstimate estimate;
  const FreeAir& air = estimate.air = find_free_air(rows, force_noise_N);
  if (!air.found) return estimate;
  // A force zero that drifts by more than its size is not identified.
  const double least_N = std::max({kLeastZero_N, kSignificantErrors * air.zero_error_N, std::abs(air.drift_N)});
  if (std::abs(air.zero_N) >= least_N) estimate.force_zero_N = air.zero_N;

  std::vector<Sample> still;
  const std::vector<Sample>* material = &rows;
  if (air.tool_mass_kg > 0.0) {
    still = rows;
    subtract_inertia(still, air.tool_mass_kg);
    material = &still;
  }
  const double threshold_N = std::max(kOnsetFloor_N, kOnsetDeviations * force_noise_N);
  const auto touches = touches_at_rest(*material, air.zero_N, threshold_N, air.inner_end_m);
  if (touches.empty()) return estimate;
  Onset onset = find_onset(*material, touches, air.zero_N, force_noise_N);
  onset.standard_error_m = std::hypot(onset.standard_error_m, onset.misfit_m);
  if (kSignificantErrors * onset.standard_error_m > kWidestSurface_m) return estimate;
  estimate.raw_offset_m = onset.at_m;
  estimate.standard_error_m = onset.standard_error_m;
  const bool significant = std::abs(onset.at_m) > std::max(kLeastOffset_m, kSignificantErrors * onset.standard_error_m);
  if (significant) estimate.offset_m = onset.at_m;
  estimate_drift(estimate, *material, touches, air.zero_N, force_noise_N);
  return estimate;
}

SurfaceEstimate estimate_surface(const Recording& recording) {
  return estimate_surface(thinned_rows(recording, kEstimateRows),
                          identify_force_noise_N(recording.rows.data(), recording.rows.size()));
}

}  // namespace palpate
