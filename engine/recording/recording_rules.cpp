#include "engine/recording/recording_rules.h"

#include <algorithm>

#include "engine/base/text.h"

namespace palpate {
namespace {

// The advice for a median step outside of the valid range.
std::string rate_advice(double step_s) {
  struct Unit {
    const char* name;
    const char* divisor;
    double seconds;
  };
  static constexpr Unit kUnits[] = {
      {"milliseconds", "1000", 1e-3}, {"microseconds", "1000000", 1e-6}, {"nanoseconds", "1000000000", 1e-9}};
  if (step_s < 1.0 / kMaximumRate_Hz) return "keep fewer samples, or check that time_s is in seconds";
  for (const Unit& unit : kUnits) {
    if (rate_in_range(step_s * unit.seconds)) {
      return "if time_s is in " + std::string(unit.name) + ", divide it by " + unit.divisor +
             ", otherwise record faster";
    }
  }
  return "record faster, or check that time_s is in seconds";
}

}  // namespace

bool rate_in_range(double step_s) {
  return step_s <= (1.0 + kRateTolerance) / kMinimumRate_Hz && step_s >= (1.0 - kRateTolerance) / kMaximumRate_Hz;
}

RowFault RowRules::explain(const RecordingRow& row) const {
  const auto fault = [](ColumnRole role, double found, const std::string& words) {
    const std::string name(kColumnNames[static_cast<std::size_t>(role)]);
    return RowFault{RowFault::Place::kThisRow, role, "found " + name + " " + shortest(found) + words};
  };
  const auto values = column_values(row);
  const auto wrong = std::ranges::find_if_not(values, [](double value) { return std::isfinite(value); });
  if (wrong != values.end()) {
    return fault(static_cast<ColumnRole>(wrong - values.begin()), *wrong,
                 ", expected a finite number; remove the row or repair the value");
  }
  if (!(row.time_s > last_time_s_)) {
    return fault(ColumnRole::kTime, row.time_s,
                 " after " + shortest(last_time_s_) + ", expected a later time in every row; " +
                     (row.time_s == last_time_s_ ? "remove the repeated row or write time_s with more digits"
                                                 : "sort the rows, or split the file where time starts again"));
  }
  if (std::abs(row.position_m) > kMaximumPosition_m) {
    return fault(
        ColumnRole::kPosition, row.position_m,
        ", expected metres from the surface, at most 1 either way; it looks like millimetres: palpate import FILE "
        "--units mm,N --out REC.csv");
  }
  return fault(ColumnRole::kForce, row.force_N,
               ", expected newtons, at most 1000000 either way; check the unit of the column");
}

// Accepts a row among the first ones, from which the rate is checked.
std::optional<RowFault> RowRules::accept_early(const RecordingRow& row) {
  if (rows_ > 0) steps_s_.push_back(row.time_s - last_time_s_);
  last_time_s_ = row.time_s;
  ++rows_;
  return rows_ == kRateRows ? check_rate() : std::nullopt;
}

std::optional<RowFault> RowRules::check_rate() {
  // With an even number of steps the median is the upper of the two middle ones.
  const auto middle = steps_s_.begin() + static_cast<std::ptrdiff_t>(steps_s_.size() / 2);
  std::nth_element(steps_s_.begin(), middle, steps_s_.end());
  const double step_s = *middle;
  if (rate_in_range(step_s)) return std::nullopt;
  return RowFault{RowFault::Place::kFirstRow, ColumnRole::kTime,
                  "found a median time step of " + general(step_s, 3) + " s (" + general(1.0 / step_s, 3) +
                      " Hz), expected 10 Hz to 20 kHz; " + rate_advice(step_s)};
}

std::optional<RowFault> RowRules::finish() {
  if (rows_ < kRecordingMinimumRows) {
    return RowFault{RowFault::Place::kEnd, ColumnRole::kTime,
                    "found " + std::to_string(rows_) + (rows_ == 1 ? " row" : " rows") + ", expected at least " +
                        std::to_string(kRecordingMinimumRows) + "; record for longer"};
  }
  return rows_ < kRateRows ? check_rate() : std::nullopt;
}

}  // namespace palpate
