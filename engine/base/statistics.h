// Order statistics, and the mean of paired differences. Thread guarantee: pure functions; they allocate.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

// The value at index `n` in ascending order.
template <typename T = double>
T nth_smallest(std::vector<T> values, std::size_t n) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// The quantile by nearest rank: the smallest value that `percent` % of the values do not exceed; 0 for no values.
template <typename T = double>
T quantile_of(std::vector<T> values, std::size_t percent) {
  const std::size_t rank = std::max<std::size_t>(1, (values.size() * percent + 99) / 100);
  return values.empty() ? T{} : nth_smallest(std::move(values), rank - 1);
}

// The median (the upper one of an even number); 0 for no values.
template <typename T = double>
T median_of(std::vector<T> values) {
  const std::size_t middle = values.size() / 2;
  return values.empty() ? T{} : nth_smallest(std::move(values), middle);
}

struct MeanValue {
  double value = 0.0;
  double standard_error = 0.0;  // 0 with fewer than two values
};
// The mean of independent values; 0 for none. Of paired differences it is that of a paired t-test.
inline MeanValue mean_of(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  MeanValue mean;
  if (values.empty()) return mean;
  for (const double value : values) mean.value += value / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean.value) * (value - mean.value);
  if (count > 1.0) mean.standard_error = std::sqrt(squares / (count - 1.0) / count);
  return mean;
}

}  // namespace palpate
