#include "engine/base/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {

double nth_smallest(std::vector<double> values, std::size_t n) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

double median_of(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  return values.empty() ? 0.0 : nth_smallest(std::move(values), middle);
}

MeanValue mean_of(std::span<const double> values) {
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
