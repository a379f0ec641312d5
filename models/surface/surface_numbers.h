// What the files about surfaces share: when a number is not known, and when it counts.
// Thread guarantee: pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpate {

// The standard error of a number that a recording does not tell.
inline constexpr double kUnknownError = std::numeric_limits<double>::infinity();
// An offset counts when it is this many standard errors from 0.
inline constexpr double kSignificantErrors = 2.0;
// Smaller offsets are not told from 0: no motion estimate from one touch is finer.
inline constexpr double kLeastOffset_m = 0.02e-3;
// A surface that is not told better than to this, two standard errors, is not told: in
// soft materials, where forces begin to rise by 0.1 N/mm, it is one JND.
inline constexpr double kWidestSurface_m = 0.5e-3;

// No place is searched for more finely.
inline constexpr double kFinest_m = 2e-6;

// What an error counts: its square up to `limit`, in proportion beyond (Huber 1964).
inline double huber(double error, double limit) {
  const double size = std::abs(error);
  return size <= limit ? size * size : limit * (2.0 * size - limit);
}

// 0 for no values.
inline double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace palpate
