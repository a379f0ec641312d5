// Where a cost has its minimum, how sure that is, and whether it can be told at all:
// the one search behind shifts, surfaces and lags.
//
// The cost comes in blocks, pieces of the recordings that err independently. A scan over the
// whole range and golden sections at its lowest valleys find the best place. Its standard error
// is the jackknife's: how far the minimum moves when one block after the other is left out
// (Quenouille 1956; Tukey 1958), sqrt((n - 1)/n sum_b (x_b - mean)^2). Not told is a place
// whose two standard errors reach an edge of the range or are wider than `widest`, and
// one of two valleys as good as each other, neither certainly worse (acceptance.h).
// Within two standard errors of 0 it is 0: what was recorded stands until the evidence is
// against it, or lies outside of the range.
// What a material imitates (friction a shift, viscosity a lag) errs in all blocks alike, which no
// jackknife sees: such a place is told when 0 is certainly worse;
// and where the material imitates within `blur`, when all that far from it is certainly worse and
// 0 further away.
// Thread guarantee: slow side, pure.
#pragma once

#include <functional>
#include <vector>

namespace palpate {

using BlockCosts = std::vector<double>;

struct Located {
  double at = 0.0;              // 0 where it is not told
  bool not_zero = false;        // 0 is not the best place, told or not
  double standard_error = 0.0;  // infinite: not told
  bool told = false;
  double cost = 0.0;  // J there, and at 0
  double cost_at_zero = 0.0;
  double minimum_at = 0.0;  // where J is least, told or not, and its blocks
  BlockCosts minimum{};
  // Another explanation, which J cannot distinguish from an offset that then is not told: N; 0: none.
  double force_offset_N = 0.0;
};

struct SearchRange {
  double low = 0.0;
  double high = 0.0;
  double coarse_step = 0.0;
  double fine_step = 0.0;
  double widest = 0.0;    // two standard errors of a place that is told
  bool imitated = false;  // by what the material does itself
  double blur = 0.0;
};

Located locate(const std::function<BlockCosts(double)>& cost, const SearchRange& range);

// Whether an offset of the force explains as much as the shift that was found, within one standard error
// (acceptance.h): `cost` has J by blocks for
// an offset of the force in N, of at most `most_N` either way. Then the shift is not told.
Located unless_force_offset(Located shift, const std::function<BlockCosts(double)>& cost, double most_N);

}  // namespace palpate
