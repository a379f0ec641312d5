// Parses one cell of a foreign table: a number with a decimal point or a decimal comma, or a time. All parsers return
// false for anything else and never throw.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <cstdint>
#include <string_view>

namespace palpate {

// "0.5", "-1,25e-3", "+3"; also with unambiguous thousands marks: the other mark, an apostrophe or a blank, in groups
// of three, followed by the decimal mark or repeated ("1,234.5", "1.234.567"). NaN and infinity are not numbers.
bool parse_table_number(std::string_view text, char decimal, double& value);

// "nan", "NaN", "inf", "-", "n/a": a cell for a missing value.
bool is_missing_value(std::string_view text);

// A time as whole units and a fraction, so that nanoseconds since 1970 keep their digits.
struct TableTime {
  std::int64_t whole = 0;
  double fraction = 0.0;  // of the same unit
};

// Parses a plain number as a time.
bool parse_number_time(std::string_view text, char decimal, TableTime& time);

// "2024-03-05T14:03:22.123Z", "2024-03-05 14:03:22,5", "05.03.2024 14:03:22.1",
// "3/5/2024 2:03:22.5 PM", "14:03:22.123", "03:22.123": seconds since 1970, or since midnight.
bool parse_clock_time(std::string_view text, TableTime& time);
bool has_date(std::string_view text);

}  // namespace palpate
