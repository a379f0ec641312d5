// The force of a recording over the position, and the shift between the curves of two recordings.
//
// A curve has the median force of every bin of positions, separately for loading and unloading: a higher speed raises
// the first and lowers the second, which no shift does. Curves are compared at the bins of the second, by linear
// interpolation between those of the first: e = (F2(p + shift) - F1(p)) / JND. They are comparable with 30 % overlap.
//
// Shift registration (Ramsay & Silverman, "Functional data analysis", 2005, section 7.2): the shift minimises the mean
// Huber loss of e beyond 1. The shift is 0 if, as recorded, the median of |e| over bins with a force above the JND at 0
// N is at most 1, because such a difference is below the JND. No shift is identified if this median is above 1 at the
// minimum, if the next shift on either side is not comparable, if less than 30 % of the forces in contact overlap, or
// if an offset of the force explains the difference as well.
// Thread guarantee: slow side, value type and pure functions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/tick/jnd.h"

namespace palpate {

struct ForceAtPosition {
  double position_m = 0.0;
  double force_N = 0.0;
};

class ForceCurve {
 public:
  struct Bin {
    std::array<std::optional<double>, 2> median_N;  // of loading and of unloading; none without rows
    double low_N = 0.0, high_N = 0.0;               // the central 90 % of all forces
  };

  // `rows`: at least one, in time order. A reversal by less than `bin_m`, the width of a bin, counts as noise.
  ForceCurve(const std::vector<ForceAtPosition>& rows, double bin_m);

  double bin_m() const { return bin_m_; }
  const std::vector<Bin>& bins() const { return bins_; }
  // The position of the middle of the first bin.
  double first_m() const { return first_m_; }

 private:
  double bin_m_;
  double first_m_;
  std::vector<Bin> bins_;
};

// The width of the bins of two recordings: a sixtieth of the smaller range of positions. 0 if neither has a range.
double common_bin_m(const std::vector<ForceAtPosition>& first, const std::vector<ForceAtPosition>& second);

struct CurveDifference {
  double loss = 0.0;           // mean Huber loss
  double contact_cells = 0.0;  // the number of compared medians where one of the forces is above the JND at 0 N
  double median_jnds = 0.0;    // median of |e| over these
  double median_N = 0.0;       // median of F2 - F1
  double apart_share = 0.0;    // share of the bins whose central 90 % do not overlap
};
// None if the curves are not comparable at this shift. Both have the same width of bins. `force_offset_N`: subtracted
// from the forces of `second`.
std::optional<CurveDifference> difference(const ForceCurve& first, const ForceCurve& second, double shift_m,
                                          const JndLine& jnd, double force_offset_N = 0.0);

// The shift in m, to a quarter of a bin, to be subtracted from the positions of `second`; none if it is not identified.
std::optional<double> find_shift_m(const ForceCurve& first, const ForceCurve& second, const JndLine& jnd);

}  // namespace palpate
