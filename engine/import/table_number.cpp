#include "engine/import/table_number.h"

#include <array>
#include <string>

#include "engine/base/text.h"

namespace palpate {
namespace {

// Longer cells are no numbers; doubles written out take at most 24 characters.
constexpr std::size_t kLongestNumber = 64;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_thousands_mark(char c, char decimal) {
  return c == '\'' || c == ' ' || (c == ',' && decimal == '.') || (c == '.' && decimal == ',');
}

// Writes a number with a decimal point and without thousands marks to `buffer`; returns the length, or 0 if the marks
// are ambiguous.
std::size_t with_decimal_point(std::string_view text, char decimal, char* buffer) {
  std::size_t length = 0;
  std::size_t marks = 0;
  std::size_t digits = 0;  // since the last mark
  char mark = '\0';
  bool behind_decimal = false;
  for (const char c : text) {
    if (!behind_decimal && is_thousands_mark(c, decimal)) {
      if ((mark != '\0' && c != mark) || digits == 0 || digits > 3 || (marks > 0 && digits != 3)) return 0;
      mark = c;
      ++marks;
      digits = 0;
      continue;
    }
    const bool ends_groups = c == decimal;
    if (ends_groups && marks > 0 && digits != 3) return 0;
    behind_decimal = behind_decimal || ends_groups;
    if (!behind_decimal && is_digit(c)) ++digits;
    buffer[length++] = ends_groups ? '.' : c;
  }
  if (marks == 0) return length;
  if (!behind_decimal && digits != 3) return 0;
  const bool unmistakable = marks >= 2 || behind_decimal || mark == '\'';
  return unmistakable ? length : 0;
}

}  // namespace

bool parse_table_number(std::string_view text, char decimal, double& value) {
  text = trimmed(text);
  if (text.empty() || text.size() > kLongestNumber) return false;
  const bool negative = text.front() == '-';
  if (negative || text.front() == '+') text.remove_prefix(1);
  if (text.empty() || (!is_digit(text.front()) && text.front() != decimal)) return false;
  std::array<char, kLongestNumber> buffer;
  const char* const end = buffer.data() + with_decimal_point(text, decimal, buffer.data());
  if (end == buffer.data() || parse_number(buffer.data(), end, value) != end) return false;
  if (negative) value = -value;
  return true;
}

bool is_missing_value(std::string_view text) {
  const std::string lower = lower_ascii(trimmed(text));
  for (const char* const word : {"nan", "-nan", "inf", "-inf", "+inf", "1.#qnan", "n/a", "na", "null", "none", "-"}) {
    if (lower == word) return true;
  }
  return false;
}

}  // namespace palpate
