#include "rendering/ui/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

double predicted_error_N(const HistoryPoint& tick) noexcept {
  if (!std::isnan(tick.reference_N)) return std::nan("");
  return tick.in_contact ? tick.predicted_error_N : 0.0;
}

void CurveColumns::gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s,
                          double to_s, std::size_t count) {
  const double width_s = (to_s - from_s) / static_cast<double>(count);
  const double first = std::floor(from_s / width_s);
  std::size_t next = 0;
  if (scroll(width_s, first, slots, count)) {
    next = history.first_at(std::nextafter(taken_s_, std::numeric_limits<double>::infinity()));
  } else {
    columns_.assign(count + 2, CurveColumn());
    next = history.first_at(first * width_s);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i)
    columns_[i].time_s = (first + static_cast<double>(i) + 0.5) * width_s;
  for (; next < history.size(); ++next) {
    const HistoryPoint& point = history[next];
    const double place = point.loop_time_s / width_s - first;
    if (place >= static_cast<double>(columns_.size())) break;
    if (place >= 0.0) add(point, jnd, columns_[static_cast<std::size_t>(place)]);
    taken_s_ = point.loop_time_s;
  }
  find_highest();
}

// Keeps the columns that remain in view. Returns false if there are none.
bool CurveColumns::scroll(double width_s, double first, std::size_t slots, std::size_t count) {
  const bool same = columns_.size() == count + 2 && slots == slots_ && std::abs(width_s - width_s_) < 1e-9 * width_s &&
                    first >= first_ && first - first_ < static_cast<double>(columns_.size());
  if (same) {
    const auto gone = static_cast<std::ptrdiff_t>(first - first_);
    std::move(columns_.begin() + gone, columns_.end(), columns_.begin());
    std::fill(columns_.end() - gone, columns_.end(), CurveColumn());
  } else {
    taken_s_ = -std::numeric_limits<double>::infinity();
  }
  slots_ = slots;
  width_s_ = width_s;
  first_ = first;
  return same;
}

void CurveColumns::add(const HistoryPoint& point, const JndLine& jnd, CurveColumn& column) {
  column.fault_level = std::max(column.fault_level, point.fault_level);
  const auto farthest = [&](const HistoryPoint& tick) {
    double most = -1.0;
    for (std::size_t i = 0; i < slots_; ++i) most = std::max(most, std::abs(tick.difference_over_jnd(i, jnd)));
    return most;
  };
  // The last of equal ticks; a comparison with NaN is false.
  if (!column.any || farthest(point) >= farthest(column.tick)) {
    column.tick = point;
    column.jnd_N = static_cast<float>(jnd.at(point.reference_N));
  }
  column.any = true;
  for (std::size_t i = 0; i < slots_; ++i) {
    const auto difference = static_cast<float>(point.difference_over_jnd(i, jnd));
    if (std::isnan(difference)) continue;
    // These ignore NaN.
    column.low_over_jnd[i] = std::fmin(column.low_over_jnd[i], difference);
    column.high_over_jnd[i] = std::fmax(column.high_over_jnd[i], difference);
    column.sustained_over_jnd[i] = std::fmax(column.sustained_over_jnd[i], std::abs(point.sustained_over_jnd[i]));
  }
}

void CurveColumns::find_highest() {
  highest_force_N_ = highest_sustained_ = 0.0F;
  for (const CurveColumn& column : columns_) {
    highest_force_N_ = std::fmax(highest_force_N_, column.tick.reference_N + column.jnd_N);
    for (std::size_t i = 0; i < slots_; ++i) {
      highest_force_N_ = std::fmax(highest_force_N_, column.tick.force_N[i]);
      highest_sustained_ = std::fmax(highest_sustained_, column.sustained_over_jnd[i]);
    }
  }
}

const CurveColumn* CurveColumns::at(double time_s) const noexcept {
  if (columns_.empty()) return nullptr;
  const double place = time_s / width_s_ - first_;
  if (!(place >= 0.0) || place >= static_cast<double>(columns_.size())) return nullptr;
  const CurveColumn& column = columns_[static_cast<std::size_t>(place)];
  return column.any ? &column : nullptr;
}

const CurveColumn* CurveColumns::last() const noexcept {
  const auto found =
      std::find_if(columns_.rbegin(), columns_.rend(), [](const CurveColumn& column) { return column.any; });
  return found != columns_.rend() ? &*found : nullptr;
}

}  // namespace palpate
