// Errors against the measured force, in bins that are finer at small forces, where the
// threshold changes most.
//
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <vector>

#include "engine/tick/jnd.h"
#include "scenes/report/data/report_data.h"

namespace palpate {

// Bins with fewer samples say little, and are marked.
inline constexpr std::uint64_t kFewSamples = 100;

class BinnedErrors {
 public:
  // `largest_force_N`: of all recordings. kForceBins bins up to there, each wider than
  // the one before by the same factor, the narrowest a tenth of an even one.
  BinnedErrors(const JndLine& jnd, double largest_force_N);
  void add(double model_N, double measured_N);  // forces below 0 count in the first bin
  std::vector<ErrorBin> bins() const;  // those with samples

 private:
  JndLine jnd_;
  std::vector<ErrorBin> bins_;  // the standard deviations hold sums of squares around the means
};

inline constexpr std::size_t kForceBins = 16;

}  // namespace palpate
