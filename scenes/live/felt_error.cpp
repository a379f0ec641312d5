#include "scenes/live/felt_error.h"

#include <cmath>

namespace palpate {

double FeltError::add(double time_s, double difference_over_jnd) noexcept {
  if (count_ > 0) {
    const Sample& last = samples_[(first_ + count_ - 1) % samples_.size()];
    if (time_s < last.time_s || time_s - last.time_s > kSpan_s) count_ = 0;
  }
  if (count_ == 0) sum_ = 0.0;  // nothing of earlier roundings stays
  while (count_ > 0 && (count_ == samples_.size() || samples_[first_].time_s <= time_s - kSpan_s)) {
    sum_ -= samples_[first_].difference;
    first_ = (first_ + 1) % samples_.size();
    --count_;
  }
  samples_[(first_ + count_) % samples_.size()] = {time_s, difference_over_jnd};
  ++count_;
  sum_ += difference_over_jnd;
  return std::abs(sum_) / static_cast<double>(count_);
}

}  // namespace palpate
