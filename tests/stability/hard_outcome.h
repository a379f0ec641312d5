// Counts errors and unsafe values of a hard case. Internal to hard_cases.
#pragma once

#include <cstddef>
#include <string>

#include "models/fit/fit.h"
#include "tests/stability/hard_cases.h"

namespace palpate {

HardCaseResult refused(HardCaseResult result, const std::string& message);

class OutcomeCounter {
 public:
  // Adds a value with a known true force. It is safe if it is finite and from
  // `low_N` to `high_N`.
  void add(double value_N, double truth_N, double low_N, double high_N);
  // Adds a value without a known true force.
  void add_bounded(double value_N, double low_N, double high_N);
  // Returns `result` with errors, safety and outcome.
  HardCaseResult finish(HardCaseResult result) const;

 private:
  std::size_t count_ = 0;
  std::size_t known_ = 0;  // values with a known true force
  std::size_t within_ = 0;
  std::size_t not_finite_ = 0;
  std::size_t unbounded_ = 0;
  double worst_over_jnd_ = 0.0;
  double farthest_N_ = 0.0;
};

}  // namespace palpate
