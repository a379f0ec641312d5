// Order statistics, and the mean of paired differences. Thread guarantee: pure functions; they allocate.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate {

// The value at index `n` in ascending order.
double nth_smallest(std::vector<double> values, std::size_t n);
// The median (the upper one of an even number); 0 for no values.
double median_of(std::vector<double> values);

struct MeanValue {
  double value = 0.0;
  double standard_error = 0.0;  // 0 with fewer than two values
};
// The mean of independent values; 0 for none. Of paired differences it is that of a paired t-test.
MeanValue mean_of(std::span<const double> values);

}  // namespace palpate
