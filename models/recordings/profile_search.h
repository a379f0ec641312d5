// The search for an offset (of a surface, a force lag, ...) that minimises a cost, with its standard error and a test
// whether the data identify it.
//
// The cost is a sum over blocks, pieces of the recordings with independent errors. A scan of the range and golden
// sections at its lowest minima find the best offset. Its standard error is the jackknife's, with one block left out
// at a time (Quenouille 1956; Tukey 1958): sqrt((n - 1)/n sum_b (x_b - mean)^2). The offset is not identified if two
// standard errors reach an end of the range or exceed `widest`, or if another minimum is not significantly worse
// (paired_costs.h). Within two standard errors of 0 it is 0, unless 0 is outside the range.
//
// An effect of the material that looks like an offset (friction like a shift, viscosity like a lag) is the same in all
// blocks, so that the jackknife does not show it. With such an effect the offset is identified only if 0 is
// significantly worse. If its size is given (`systematic_effect`), the costs at this distance on either side must be
// significantly worse, too, and the offset must exceed this distance plus two standard errors to differ from 0.
// Thread guarantee: slow side, pure.
#pragma once

#include <functional>
#include <vector>

namespace palpate {

using BlockCosts = std::vector<double>;

struct OffsetEstimate {
  double at = 0.0;              // the offset; 0 if not identified or not significantly different from 0
  bool not_zero = false;        // the minimum differs from 0, identified or not
  double standard_error = 0.0;  // infinite if not identified
  bool identified = false;
  double cost = 0.0;  // J at the minimum, and at 0
  double cost_at_zero = 0.0;
  double minimum_at = 0.0;  // the minimum, identified or not, and its blocks
  BlockCosts minimum{};
  // A force offset that explains the data as well, so that `at` is not identified: N; 0: none.
  double force_offset_N = 0.0;
};

struct SearchRange {
  double low = 0.0;
  double high = 0.0;
  double coarse_step = 0.0;
  double fine_step = 0.0;
  double widest = 0.0;                 // limit of two standard errors
  bool has_systematic_effect = false;  // the material has an effect that looks like an offset
  double systematic_effect = 0.0;      // 0, or the size of that effect
};

// The minimum of `cost` in `range`. Not identified where the range is empty.
OffsetEstimate estimate_offset(const std::function<BlockCosts(double)>& cost, const SearchRange& range);

// Tests whether a force offset explains the data as well as `shift`: whether the lowest cost over force offsets of
// -most_N to most_N exceeds that of the shift by at most one standard error (paired_costs.h). If so, the shift is not
// identified. `cost`: J by blocks for a force offset in N.
OffsetEstimate unless_force_offset(OffsetEstimate shift, const std::function<BlockCosts(double)>& cost, double most_N);

}  // namespace palpate
