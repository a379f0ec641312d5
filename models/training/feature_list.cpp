#include "models/training/feature_list.h"

#include <algorithm>

namespace palpate {
namespace {

// One feature of several branches; a branch alone is the older kind.
FeatureSpec spectrum_of(const FeatureSpec* branches, std::size_t count) {
  if (count == 1) return branches[0];
  FeatureSpec spec;
  spec.kind = FeatureKind::maxwell_spectrum;
  spec.part_count = count;
  spec.slowing = branches[0].slowing;
  for (std::size_t p = 0; p < count; ++p) spec.parts[p] = {branches[p].relaxation_time_s, 0.0, branches[p].drive};
  return spec;
}

}  // namespace

std::vector<double> all_times(const FeatureList& list) {
  std::vector<double> times_s;
  for (const auto& group : list.relaxation_times_s) times_s.insert(times_s.end(), group.begin(), group.end());
  return times_s;
}

TrendTerms terms_of(const FeatureList& list, double reference_depth_m, double rms_velocity_m_per_s) {
  return {reference_depth_m,    list.velocity ? rms_velocity_m_per_s : 0.0, all_times(list), list.stop_thresholds_m,
          list.peak_times_s,    list.slowing,                                list.spline_elastic,
          list.spline_branches, list.surface};
}

std::vector<FeatureSpec> features_of(const FeatureList& list, const FittedTrend& fitted) {
  std::vector<FeatureSpec> features{FeatureSpec{}};
  if (!list.surface.empty()) {
    FeatureSpec lag{FeatureKind::surface_lag};
    lag.drive.reference_depth_m = fitted.trend.reference_depth_m;
    std::copy_n(fitted.trend.elastic_N.begin(), kDriveCoefficients, lag.drive.coefficient_N.begin());
    lag.drive.has_knots = true;
    lag.drive.knot_N = fitted.trend.elastic_knot_N;
    features.push_back(lag);
  }
  if (list.velocity) features.push_back({FeatureKind::velocity});
  std::size_t next = 0;
  for (const auto& group : list.relaxation_times_s) {
    features.push_back(spectrum_of(fitted.branches.data() + next, group.size()));
    next += group.size();
  }
  if (!fitted.stops.empty()) {
    FeatureSpec stops;
    stops.kind = FeatureKind::stops;
    stops.part_count = fitted.stops.size();
    std::copy(fitted.stops.begin(), fitted.stops.end(), stops.parts.begin());
    features.push_back(stops);
  }
  for (const double time_s : list.peak_times_s) features.push_back({FeatureKind::fading_peak, time_s});
  return features;
}

}  // namespace palpate
