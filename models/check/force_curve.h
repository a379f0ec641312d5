// The force of a recording over the position, and the difference of the curves of two recordings.
//
// A curve has the median force of every bin of positions, separately for loading and unloading: a higher speed raises
// the first and lowers the second, which no shift does. Curves are compared at the bins of the second, by linear
// interpolation between those of the first. They are comparable with 30 % overlap.
// Thread guarantee: slow side, value type and pure functions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"

namespace palpate {

class ForceCurve {
 public:
  struct Bin {
    std::array<std::optional<double>, 2> median_N;  // of loading and of unloading; none without rows
    double low_N = 0.0, high_N = 0.0;               // the central 90 % of all forces
  };

  // `rows`: at least one, in time order. A reversal by less than `bin_m`, the width of a bin, counts as noise.
  ForceCurve(const std::vector<RecordingRow>& rows, double bin_m);

  double bin_m() const { return bin_m_; }
  const std::vector<Bin>& bins() const { return bins_; }
  // The position of the middle of the first bin.
  double first_m() const { return first_m_; }

 private:
  double bin_m_, first_m_;
  std::vector<Bin> bins_;
};

// The width of the bins of two recordings: a sixtieth of the smaller range of positions. 0 if neither has a range.
double common_bin_m(const std::vector<RecordingRow>& first, const std::vector<RecordingRow>& second);

struct CurveDifference {
  double median_jnds =
      0.0;                // median of |F2 - F1| / JND over the medians where one of the forces is above the JND at 0 N
  double median_N = 0.0;  // median of F2 - F1
  double apart_share = 0.0;  // share of the bins whose central 90 % do not overlap
};
// None if the curves are not comparable at this shift, which is subtracted from the positions of `second`. Both have
// the same width of bins.
std::optional<CurveDifference> difference(const ForceCurve& first, const ForceCurve& second, double shift_m,
                                          const JndLine& jnd);

}  // namespace palpate
