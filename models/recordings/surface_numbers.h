// Constants and small functions that the files of this room share.
// Thread guarantee: pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpate {

// The standard error of a quantity that a recording does not identify.
inline constexpr double kUnknownError = std::numeric_limits<double>::infinity();
// An offset is significant at this many standard errors from 0.
inline constexpr double kSignificantErrors = 2.0;
// Smaller offsets count as 0: the position estimate of one touch is no finer.
inline constexpr double kLeastOffset_m = 0.02e-3;
// A surface with a larger error (two standard errors) is not identified: in soft materials, whose force rises by
// 0.1 N/mm at first, it is one JND.
inline constexpr double kWidestSurface_m = 0.5e-3;

// The resolution of all searches.
inline constexpr double kFinest_m = 2e-6;

// Huber's loss (1964): the square of the error up to `limit`, linear beyond.
inline double huber(double error, double limit) {
  const double size = std::abs(error);
  return size <= limit ? size * size : limit * (2.0 * size - limit);
}

// The median (the upper one of an even number); 0 for no values.
inline double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace palpate
