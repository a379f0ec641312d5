// Where a cost has its minimum, how sure that is, and whether it can be told at all:
// the one search behind shifts, surfaces and lags.
//
// The cost comes in blocks, pieces of the recordings that err independently. Two places
// x and y are as good when the blocks do not agree that one is better: the mean over blocks
// of r_b = (J_b(x) - J_b(y)) / (J_b(x) + J_b(y)) is within two of its standard errors of 0,
// or the difference of the sums is below 5 % of J. A scan over the whole range and golden sections at
// its lowest valleys find the best place; all places as good as it are the interval of
// confidence. Where that reaches an edge of the range, or lies in two pieces, or is wider
// than `widest`, the place is not told. Where 0 is as good it is 0: what was recorded
// stands until the evidence is against it, or lies outside of the range.
// Thread guarantee: slow side, pure.
#pragma once

#include <functional>
#include <vector>

namespace palpate {

using BlockCosts = std::vector<double>;

struct Located {
  double at = 0.0;              // 0 where it is not told
  bool not_zero = false;        // 0 is not as good as the best place, told or not
  double standard_error = 0.0;  // a quarter of the interval's width; infinite: not told
  bool told = false;
  double cost = 0.0;  // J there, and at 0
  double cost_at_zero = 0.0;
};

struct SearchRange {
  double low = 0.0;
  double high = 0.0;
  double coarse_step = 0.0;
  double fine_step = 0.0;
  double widest = 0.0;         // interval of confidence, from its middle
  bool zero_suffices = false;  // where no place of the scan is better, no more is asked
};

Located locate(const std::function<BlockCosts(double)>& cost, const SearchRange& range);

}  // namespace palpate
