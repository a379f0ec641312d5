#include "scenes/live/evaluation_time.h"

#include <algorithm>

namespace palpate {

void EvaluationTime::add(float time_ns) noexcept {
  values_ns_[count_ % kValues] = time_ns;
  ++count_;
  if (count_ % kRenewal == 0 || count_ == 1) renew();
}

void EvaluationTime::renew() noexcept {
  std::array<float, kValues> sorted = values_ns_;
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kValues));
  const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
  std::nth_element(sorted.begin(), middle, end);
  median_ns_ = static_cast<double>(*middle);
}

}  // namespace palpate
