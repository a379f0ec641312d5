// How far a model's force is from the measured one, in newtons and in just
// noticeable differences, over the samples in contact.
//
// Thread guarantee: one thread per object; slow side (allocates).
// Source: figures 4 to 7 of Hoever & Harders (2009) for the force bins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/jnd.h"
#include "engine/tick/error_figures.h"

namespace palpate {

// Without samples every figure is 0 and there are no bins; whoever shows them
// looks at `samples` first.
struct ErrorSummary {
  std::uint64_t samples = 0;
  double rms_error_N = 0.0;
  double max_error_N = 0.0;
  double within_jnd = 0.0;  // share of the samples with an error up to one JND
  double p99_error_over_jnd = 0.0;  // nearest rank: 99 % of the samples are no worse
  double max_error_over_jnd = 0.0;
  std::uint64_t out_of_domain_samples = 0;
  // From 0 to the largest measured force; forces below 0 (sensor noise) count in
  // the first bin.
  std::vector<ForceBin> bins;
};

// Takes 4 bytes a sample, for the exact percentile; all else is constant.
class ErrorStatistics {
 public:
  explicit ErrorStatistics(const JndLine& jnd) : jnd_(jnd) {}

  // One sample in contact: both forces finite.
  void add(double model_N, double measured_N, bool out_of_domain);

  ErrorSummary summary() const;

 private:
  JndLine jnd_;
  ErrorFigures figures_;
  std::vector<float> ratios_;
};

}  // namespace palpate
