#include "scenes/live/force_history.h"

#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kTicksPerSecond = 1000.0;

}  // namespace

double HistoryPoint::difference_over_jnd(std::size_t slot, const JndLine& jnd) const noexcept {
  const bool none = std::isnan(reference_N) || std::isnan(force_N[slot]) || (foreign >> slot & 1U) != 0;
  if (none || (in_contact && !counts)) return std::numeric_limits<double>::quiet_NaN();
  const auto from_N = static_cast<double>(reference_N);
  return in_contact ? (static_cast<double>(force_N[slot]) - from_N) / jnd.at(from_N) : 0.0;
}

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

const HistoryPoint* ForceHistory::last_until(double loop_time_s) const noexcept {
  const std::size_t next = first_at(std::nextafter(loop_time_s, std::numeric_limits<double>::infinity()));
  return next > 0 ? &(*this)[next - 1] : nullptr;
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
