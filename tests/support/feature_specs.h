// Builds feature specifications and feeds a filter with exact motion estimates.
#pragma once

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "engine/tick/features.h"

namespace palpate::test {

inline FeatureSpec lowpass(double relaxation_time_s) { return {FeatureKind::lowpass_velocity, relaxation_time_s, {}}; }

inline DriveCurve stiffening() { return {5e-3, {0.8, 0.5, 0.3, 0.2}}; }

inline const FeatureVector& feed(FeatureFilter& filter, double time_s, double position_m,
                                 double velocity_m_per_s = 0.0) {
  return filter.update({time_s, position_m, 0.0, 0.0}, {position_m, velocity_m_per_s});
}

inline FeatureSpec stops(std::initializer_list<double> thresholds_m, const DriveCurve& drive) {
  FeatureSpec spec;
  spec.kind = FeatureKind::stops;
  for (const double threshold_m : thresholds_m) spec.parts[spec.part_count++] = {0.0, threshold_m, drive};
  return spec;
}

inline FeatureSpec spectrum(std::initializer_list<double> times_s, const DriveCurve& drive) {
  FeatureSpec spec;
  spec.kind = FeatureKind::maxwell_spectrum;
  for (const double time_s : times_s) spec.parts[spec.part_count++] = {time_s, 0.0, drive};
  return spec;
}

inline FeatureSpec creep(std::initializer_list<double> times_s, const DriveCurve& drive) {
  FeatureSpec spec;
  spec.kind = FeatureKind::creep;
  for (const double time_s : times_s) spec.parts[spec.part_count++] = {time_s, 5e-3, drive};
  return spec;
}

// A closed motion in contact, of several incommensurable sines.
inline double closed_motion_m(double phase) {
  const double angle = 2.0 * std::numbers::pi * phase;
  return 4e-3 - 1.5e-3 * std::cos(angle) + 0.8e-3 * std::sin(7.0 * angle) + 0.3e-3 * std::sin(31.0 * angle);
}

}  // namespace palpate::test
