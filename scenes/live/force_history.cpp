#include "scenes/live/force_history.h"

namespace palpate {
namespace {

constexpr double kTicksPerSecond = 1000.0;

}  // namespace

ForceHistory::ForceHistory() : points_(static_cast<std::size_t>(kHistory_s * kTicksPerSecond)) {}

std::size_t ForceHistory::first_at(double loop_time_s) const noexcept {
  std::size_t from = 0;
  std::size_t to = size_;
  while (from < to) {
    const std::size_t middle = from + (to - from) / 2;
    if ((*this)[middle].loop_time_s < loop_time_s) {
      from = middle + 1;
    } else {
      to = middle;
    }
  }
  return from;
}

void ForceHistory::append(const HistoryPoint& point) {
  if (size_ < points_.size()) {
    points_[size_++] = point;
    return;
  }
  points_[first_] = point;
  if (++first_ == points_.size()) first_ = 0;
}

}  // namespace palpate
