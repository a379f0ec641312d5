#include "engine/import/row_times.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace palpate {
namespace {

constexpr std::int64_t kDay_s = 86400;

}  // namespace

double RowTimes::examine(const std::vector<std::string_view>& fields) {
  std::vector<double> steps;
  TableTime last;
  for (std::size_t row = 0; row < fields.size(); ++row) {
    TableTime time;
    if (row == 0) {
      clock_ = !parse_number_time(fields[row], decimal_, time) && parse_clock_time(fields[row], time);
      has_date_ = clock_ && has_date(fields[row]);
    }
    if (!parse(fields[row], time)) break;
    const double step = static_cast<double>(time.whole - last.whole) + (time.fraction - last.fraction);
    if (row > 0 && step > 0.0) steps.push_back(step);
    last = time;
  }
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

bool RowTimes::parse(std::string_view field, TableTime& time) const {
  return clock_ ? parse_clock_time(field, time) : parse_number_time(field, decimal_, time);
}

RowTimes::Step RowTimes::add(const TableTime& time) noexcept {
  if (!std::exchange(started_, true)) {
    first_ = time;
    return Step::later;
  }
  const bool midnight = clock_ && !has_date_ && last_s_ - seconds(time) > 0.5 * static_cast<double>(kDay_s);
  if (midnight) ++midnights_;
  const double now_s = seconds(time);
  if (now_s == last_s_) return Step::repeated;
  if (!(now_s > last_s_)) return Step::backward;
  last_s_ = now_s;
  return midnight ? Step::after_midnight : Step::later;
}

double RowTimes::seconds(const TableTime& time) const noexcept {
  return (static_cast<double>(time.whole - first_.whole + midnights_ * kDay_s) + (time.fraction - first_.fraction)) *
         to_si_;
}

}  // namespace palpate
