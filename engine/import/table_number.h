// Parses one cell of a foreign table as a number with a decimal point or a decimal comma.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <string_view>

namespace palpate {

// Whether `text` is a number, which is then in `value`: "0.5", "-1,25e-3", "+3"; also with unambiguous thousands marks:
// the other mark, an apostrophe or a blank, in groups of three, followed by the decimal mark or repeated ("1,234.5",
// "1.234.567"). NaN and infinity are not numbers.
bool parse_table_number(std::string_view text, char decimal, double& value);

// "nan", "NaN", "inf", "-", "n/a": a cell for a missing value.
bool is_missing_value(std::string_view text);

}  // namespace palpate
