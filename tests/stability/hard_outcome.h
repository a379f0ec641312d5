// How a hard case ended, in figures and in words. Internal to hard_cases.
#pragma once

#include <cstddef>
#include <string>

#include "models/fit/fit.h"
#include "tests/stability/hard_cases.h"

namespace palpate {

HardCaseResult refused(HardCaseResult result, const std::string& message);

class OutcomeCounter {
 public:
  // A value where the truth is known; it must be finite and from `low_N` to
  // `high_N` to count as safe.
  void add(double value_N, double truth_N, double low_N, double high_N);
  // A value where nobody knows the truth.
  void add_bounded(double value_N, double low_N, double high_N);
  // `result` with errors, safety and a sentence.
  HardCaseResult finish(HardCaseResult result) const;

 private:
  std::size_t count_ = 0;
  std::size_t known_ = 0;  // with a truth
  std::size_t within_ = 0;
  std::size_t not_finite_ = 0;
  std::size_t unbounded_ = 0;
  double worst_over_jnd_ = 0.0;
  double farthest_N_ = 0.0;
};

}  // namespace palpate
