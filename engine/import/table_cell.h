// The cells of a foreign table: numbers with a decimal point or comma, missing values, and times, which are those of a
// clock or numbers.
// Thread guarantee: pure functions and a value type, slow side.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/recording/recording.h"

namespace palpate {

// Whether `text` is a number, which is then in `value`: "0.5", "-1,25e-3", "+3"; also with unambiguous thousands marks:
// the other mark, an apostrophe or a blank, in groups of three, followed by the decimal mark or repeated ("1,234.5",
// "1.234.567"). NaN and infinity are not numbers.
bool parse_table_number(std::string_view text, char decimal, double& value);
// "nan", "NaN", "inf", "-", "n/a": a cell for a missing value.
bool is_missing_value(std::string_view text);
// Whether `field` is a date or a time of day:
// "2024-03-05T14:03:22.123Z", "2024-03-05 14:03:22,5", "05.03.2024 14:03:22.1",
// "3/5/2024 2:03:22.5 PM", "14:03:22.123", "03:22.123".
bool is_of_a_clock(std::string_view field);

// A time as whole units and a fraction, so that nanoseconds since 1970 keep their digits. The time of a clock is in
// seconds since 1970 or, without a date, since midnight.
struct TableTime {
  std::int64_t whole = 0;
  double fraction = 0.0;
};

// The times of the rows.
class RowTimes {
 public:
  explicit RowTimes(char decimal) : decimal_(decimal) {}

  // Determines from the fields of the first rows whether the times are those of a clock. Returns the median step
  // from a row to the next, as in the file; rows that share a time share a step. 0 without any step.
  double examine(const std::vector<std::string_view>& fields);
  bool are_of_a_clock() const noexcept { return clock_; }
  bool have_dates() const noexcept { return has_date_; }

  // The time since that of the first call, in the unit of the file (a clock: s); none if `field` is no time. A clock
  // without dates that goes back by more than half a day has passed midnight.
  std::optional<double> since_first(std::string_view field);
  int midnights() const noexcept { return midnights_; }
  // The time of the first call itself.
  double first() const noexcept { return first_ ? static_cast<double>(first_->whole) + first_->fraction : 0.0; }

 private:
  std::optional<TableTime> parse(std::string_view field) const;

  char decimal_;
  bool clock_ = false, has_date_ = false;
  std::optional<TableTime> first_;
  double last_ = 0.0;
  int midnights_ = 0;
};

struct RepeatedTimes {
  std::size_t rows = 0;           // number of rows with the time of the row above
  bool copies = true;             // all of them have its position and force, too
  double mean_rate_Hz = 0.0;      // of evenly spaced rows
  double step_s = 0.0;            // median step of the times
  std::optional<double> rate_Hz;  // the same if the clock is coarse: equal steps, equally many rows for each time
};

// `rows`: times that do not fall.
RepeatedTimes find_repeated_times(const std::vector<RecordingRow>& rows);

}  // namespace palpate
