// Searches the offset (of a surface, a force lag, ...) with the lowest cost, gives its standard error, and tests
// whether the data identify it.
//
// The cost is a sum over blocks, pieces of the recordings with independent errors. A scan of the range and golden
// sections at its lowest minima find the best offset. Its standard error is the jackknife's, with one block left out
// at a time (Quenouille 1956; Tukey 1958): sqrt((n - 1)/n sum_b (x_b - mean)^2). The offset is not identified if two
// standard errors reach an end of the range or exceed `widest`, or if another minimum is not significantly worse.
// Within two standard errors of 0 it is 0.
//
// Two candidates, a and b, are compared by their costs a_k and b_k over the same n blocks. Block k gives the relative
// difference r_k = (a_k - b_k) / (a_k + b_k + m / 10), where m is the mean of the b_k. Candidate a is significantly
// worse if mean r > 2 s / sqrt(n), s the standard deviation of r: a paired t-test at two standard errors.
//
// An effect of the material that looks like an offset (viscosity looks like a lag) is the same in all blocks, so that
// the jackknife does not show it. With such an effect of known size (`systematic_effect`) the offset is identified only
// if the costs at 0 and at this distance on either side are significantly worse. It must exceed the effect plus two
// standard errors to differ from 0.
// Thread guarantee: slow side, pure.
#pragma once

#include <cmath>
#include <functional>
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

using BlockCosts = std::vector<double>;
// The cost J, by blocks, of an offset.
using CostFunction = std::function<BlockCosts(double)>;

struct OffsetEstimate {
  double at = 0.0;                        // the offset; 0 if not identified or not significantly different from 0
  bool not_zero = false;                  // the minimum differs from 0 significantly
  double standard_error = kUnknownError;  // infinite if not identified
  bool identified = false;
  double minimum_at = 0.0;  // the minimum, identified or not, and its costs
  BlockCosts minimum{};
  // N: a force offset that explains the data as well, so that `at` is not identified; 0: there is none.
  double force_offset_N = 0.0;
};

struct SearchRange {
  double low = 0.0;
  double high = 0.0;
  double coarse_step = 0.0;
  double fine_step = 0.0;
  double widest = 0.0;             // limit of two standard errors
  double systematic_effect = 0.0;  // of the material, in units of the offset; 0: none
};

// The minimum of `cost` in `range`, which contains 0. Not identified where the range is empty.
OffsetEstimate estimate_offset(const CostFunction& cost, const SearchRange& range);

// Tests whether a force offset explains the data as well as `shift`: whether the lowest cost over force offsets of
// -most_N to most_N exceeds that of the shift by at most one standard error of their paired differences. If so, the
// shift is not identified. `cost`: J by blocks for a force offset in N.
OffsetEstimate unless_force_offset(OffsetEstimate shift, const CostFunction& cost, double most_N);

}  // namespace palpate
