// Inference from few independent units: a mean over n units has the standard error s / sqrt(n) and Student's t
// with n - 1 degrees of freedom.
// Source: Cochran (1977), Sampling Techniques, 2.7 and 6.4 (cluster samples, ratio estimator).
// Thread guarantee: pure functions.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpate {

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool known() const { return std::isfinite(low) && std::isfinite(high); }
};
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// With fewer units there is no interval: with two units t is 12.7, and the interval would be useless.
inline constexpr std::size_t kLeastUnits = 3;

// The value that Student's t with `degrees` >= 1 degrees of freedom exceeds with probability `above`, 0 to 0.5.
// Source: Abramowitz & Stegun (1972), 26.7.3 and 26.7.4.
double student_t(double above, std::size_t degrees);

// Standard error of the mean of `values`; NaN with fewer than kLeastUnits.
double standard_error(const std::vector<double>& values);

// Standard error of sum(numerators) / sum(denominators), with one of each per unit; NaN with fewer than kLeastUnits.
double ratio_standard_error(const std::vector<double>& numerators, const std::vector<double>& denominators);

// estimate -+ t error, 95 %, two-sided; NaN where `error` is NaN.
Interval interval_95(double estimate, double error, std::size_t units);
// estimate + t error, 95 %, one-sided; a negative error gives the lower bound. NaN where `error` is NaN.
double bound_95(double estimate, double error, std::size_t units);

}  // namespace palpate
