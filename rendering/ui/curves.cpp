#include "rendering/ui/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// NaN counts as nothing.
float smaller(float so_far, float value) noexcept {
  return value < so_far || std::isnan(so_far) ? value : so_far;
}
float larger(float so_far, float value) noexcept {
  return value > so_far || std::isnan(so_far) ? value : so_far;
}

}  // namespace

void CurveColumns::gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s,
                          double to_s, std::size_t count) {
  const double width_s = (to_s - from_s) / static_cast<double>(count);
  const double first = std::floor(from_s / width_s);
  CurveColumn empty;
  empty.low_N.fill(kNone);
  empty.high_N.fill(kNone);
  empty.error_over_jnd.fill(kNone);
  columns_.assign(count + 2, empty);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    columns_[i].time_s = (first + static_cast<double>(i) + 0.5) * width_s;
  highest_force_N_ = highest_error_ = 0.0F;
  for (std::size_t i = history.first_at(first * width_s); i < history.size(); ++i) {
    const HistoryPoint& point = history[i];
    const double place = point.loop_time_s / width_s - first;
    if (place < 0.0) continue;
    const auto index = static_cast<std::size_t>(place);
    if (index >= columns_.size()) break;
    take(point, jnd, slots, columns_[index]);
  }
}

void CurveColumns::take(const HistoryPoint& point, const JndLine& jnd, std::size_t slots,
                        CurveColumn& column) {
  column.trouble = std::max(column.trouble, point.trouble);
  column.contact = column.contact || point.in_contact;
  const bool known = !std::isnan(point.reference_N);
  const auto jnd_N = static_cast<float>(jnd.at(static_cast<double>(point.reference_N)));
  if (known) {
    const float low_N = point.reference_N - jnd_N;
    const float high_N = point.reference_N + jnd_N;
    column.band_low_N = column.reference ? std::min(column.band_low_N, low_N) : low_N;
    column.band_high_N = column.reference ? std::max(column.band_high_N, high_N) : high_N;
    column.reference_N = point.reference_N;
    column.reference = true;
    highest_force_N_ = std::max(highest_force_N_, high_N);
  }
  column.any = true;
  for (std::size_t i = 0; i < slots; ++i) {
    const float force_N = point.force_N[i];
    if (std::isnan(force_N)) continue;
    column.low_N[i] = smaller(column.low_N[i], force_N);
    column.high_N[i] = larger(column.high_N[i], force_N);
    highest_force_N_ = std::max(highest_force_N_, force_N);
    if (!known || !point.in_contact) continue;
    const float ratio = std::abs(force_N - point.reference_N) / jnd_N;
    column.error_over_jnd[i] = larger(column.error_over_jnd[i], ratio);
    highest_error_ = std::max(highest_error_, ratio);
  }
}

}  // namespace palpate
