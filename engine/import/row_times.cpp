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

double RowTimes::since_first(const TableTime& time) noexcept {
  if (!std::exchange(started_, true)) first_ = time;
  const auto with_midnights = [&] {
    const std::int64_t whole = time.whole - first_.whole + midnights_ * kDay_s;
    return static_cast<double>(whole) + (time.fraction - first_.fraction);
  };
  if (clock_ && !has_date_ && last_ - with_midnights() > 0.5 * static_cast<double>(kDay_s)) ++midnights_;
  return last_ = with_midnights();
}

}  // namespace palpate
