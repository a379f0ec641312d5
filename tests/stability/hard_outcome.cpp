#include "tests/stability/hard_outcome.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace palpate {

HardCaseResult refused(HardCaseResult result, const std::string& message) {
  result.safe = true;
  result.outcome = "refused: " + message;
  return result;
}

void OutcomeCounter::add(double value_N, double truth_N, double low_N, double high_N) {
  add_bounded(value_N, low_N, high_N);
  ++known_;
  if (!std::isfinite(value_N)) return;
  const double over_jnd = JndLine{}.error_over_jnd(value_N, truth_N);
  worst_over_jnd_ = std::max(worst_over_jnd_, over_jnd);
  if (over_jnd <= 1.0) ++within_;
}

void OutcomeCounter::add_bounded(double value_N, double low_N, double high_N) {
  ++count_;
  if (!std::isfinite(value_N)) {
    ++not_finite_;
    return;
  }
  if (value_N >= low_N && value_N <= high_N) return;
  ++unbounded_;
  farthest_N_ = std::max(farthest_N_, std::abs(value_N));
}

HardCaseResult OutcomeCounter::finish(HardCaseResult result) const {
  result.worst_over_jnd = worst_over_jnd_;
  result.within_jnd = known_ > 0 ? static_cast<double>(within_) / static_cast<double>(known_) : 0.0;
  result.safe = not_finite_ == 0 && unbounded_ == 0;
  char text[160];
  if (not_finite_ > 0) {
    std::snprintf(text, sizeof text, "%zu of %zu values are not finite", not_finite_, count_);
  } else if (unbounded_ > 0) {
    std::snprintf(text, sizeof text, "%zu of %zu values out of bounds, up to %.3g N", unbounded_, count_, farthest_N_);
  } else if (known_ == 0) {
    std::snprintf(text, sizeof text, "finite and within bounds, %zu values", count_);
  } else if (worst_over_jnd_ <= 1.0) {
    std::snprintf(text, sizeof text, "within the JND, worst error %.2g JND", worst_over_jnd_);
  } else {
    std::snprintf(text, sizeof text, "bounded: %.1f %% within the JND, worst error %.3g JND", 100.0 * result.within_jnd,
                  worst_over_jnd_);
  }
  result.outcome = text;
  return result;
}

}  // namespace palpate
