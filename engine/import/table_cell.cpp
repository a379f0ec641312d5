#include "engine/import/table_cell.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/import/units.h"

namespace palpate {
namespace {

// Longer cells are no numbers; doubles written out take at most 24 characters.
constexpr std::size_t kLongestNumber = 64;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr std::int64_t kDay_s = 86400;

double since(const TableTime& time, const TableTime& first) {
  return static_cast<double>(time.whole - first.whole) + (time.fraction - first.fraction);
}

// Parses and removes up to `most` digits at the start of `text`.
bool parse_digits(std::string_view& text, std::size_t most, int& value) {
  const auto parsed = std::from_chars(text.data(), text.data() + std::min(text.size(), most), value);
  if (text.starts_with('-') || parsed.ec != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(parsed.ptr - text.data()));
  return true;
}

bool skip_one_of(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

// Parses and removes a date at the start of `text`. Only differences between rows count, so that within a day either
// reading of 3/5/2024 is adequate.
bool parse_date(std::string_view& text, std::int64_t& days) {
  std::string_view rest = text;
  std::array<int, 3> parts{};
  if (!parse_digits(rest, 4, parts[0])) return false;
  const std::string_view mark = rest.substr(0, 1);
  if (!skip_one_of(rest, "-/.") || !parse_digits(rest, 2, parts[1]) || !skip_one_of(rest, mark) ||
      !parse_digits(rest, 4, parts[2]))
    return false;
  if (parts[0] < 32) std::swap(parts[0], parts[2]);
  if (parts[1] > 12) std::swap(parts[1], parts[2]);
  if (parts[0] < 32 || parts[1] < 1 || parts[1] > 12 || parts[2] < 1 || parts[2] > 31) return false;
  // Days since 1970; the library's calendar takes the 31st of every month.
  days = (std::chrono::sys_days(std::chrono::year(parts[0]) / parts[1] / 1).time_since_epoch()).count() + parts[2] - 1;
  text = rest;
  return true;
}

bool has_date(std::string_view text) {
  text = trimmed(text);
  std::int64_t days = 0;
  return parse_date(text, days);
}

// A plain number as a time.
std::optional<TableTime> parse_number_time(std::string_view text, char decimal) {
  TableTime time;
  text = trimmed(text);
  const auto whole = std::from_chars(text.data(), text.data() + text.size(), time.whole);
  const std::string_view rest = text.substr(static_cast<std::size_t>(whole.ptr - text.data()));
  if (whole.ec == std::errc() && rest.empty()) return time;
  if (whole.ec == std::errc() && time.whole > 0 && rest.front() == decimal &&
      rest.find_first_not_of("0123456789", 1) == std::string_view::npos) {
    parse_table_number(std::string("0").append(rest), decimal, time.fraction);
    return time;
  }
  double value = 0.0;
  constexpr double kLargest = 9e18;  // fits in 64 bits
  if (!parse_table_number(text, decimal, value) || std::abs(value) > kLargest) return std::nullopt;
  return TableTime{static_cast<std::int64_t>(std::floor(value)), value - std::floor(value)};
}

std::optional<TableTime> parse_clock_time(std::string_view text) {
  text = trimmed(text);
  std::int64_t days = 0;
  if (parse_date(text, days)) {
    if (!skip_one_of(text, "T ")) return std::nullopt;
    text = trimmed(text);
  }
  int first = 0, second = 0, third = 0;
  if (!parse_digits(text, 4, first) || !skip_one_of(text, ":") || !parse_digits(text, 2, second) || second > 59)
    return std::nullopt;
  const bool has_hours = skip_one_of(text, ":");
  if (has_hours && (!parse_digits(text, 2, third) || third > 60)) return std::nullopt;
  TableTime time;
  if (text.starts_with('.') || text.starts_with(',')) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789", 1), text.size());
    const std::string digits = std::string("0.").append(text.substr(1, end - 1));
    std::from_chars(digits.data(), digits.data() + digits.size(), time.fraction);
    text.remove_prefix(end);
  }
  const std::int64_t hours = has_hours ? first : 0;
  time.whole = days * kDay_s + hours * 3600 + (has_hours ? second : first) * 60 + (has_hours ? third : second);
  text = trimmed(text);
  const std::string half = lower_ascii(text.substr(0, 2));
  if (half == "am" || half == "pm") {
    if (half == "pm" && first < 12) time.whole += kDay_s / 2;
    if (half == "am" && first == 12) time.whole -= kDay_s / 2;
    text.remove_prefix(2);
  }
  // The time zone, "Z" or "+01:00", is the same in every row.
  const bool ends = text.empty() || text == "Z" || text.front() == '+' || text.front() == '-';
  return ends ? std::optional(time) : std::nullopt;
}

// Fewer times do not show that they are regular. The first and the last one may have fewer rows.
constexpr std::size_t kLeastTimes = 6;
// Fewer rows for each time are single repetitions.
constexpr double kLeastRows = 1.5;
// The deviation from the mean that the jitter of a logger explains, at least one row; rows and steps may exceed it in
// one of twenty.
constexpr double kJitter = 0.15;
constexpr double kRegularShare = 0.95;
// A longer step is a pause, after which the rows are not evenly spaced.
constexpr double kPauseSteps = 1.5;

// Rows with one time.
struct Group {
  double time_s = 0.0, rows = 0.0;
};

bool is_regular(const std::vector<double>& values, double middle, double tolerance) {
  const auto near = std::ranges::count_if(values, [&](double value) { return std::abs(value - middle) <= tolerance; });
  return static_cast<double>(near) >= kRegularShare * static_cast<double>(values.size());
}

}  // namespace

bool parse_table_number(std::string_view text, char decimal, double& value) {
  text = trimmed(text);
  if (text.empty() || text.size() > kLongestNumber) return false;
  const bool negative = text.front() == '-';
  if (negative || text.front() == '+') text.remove_prefix(1);
  if (text.empty() || (!is_digit(text.front()) && text.front() != decimal)) return false;
  const std::size_t point = std::min(text.find(decimal), text.size());
  std::string_view whole = text.substr(0, point);
  std::string plain;  // the whole part without thousands marks
  if (const std::size_t at = whole.find_first_of(decimal == '.' ? ",' " : ".' "); at < point) {
    const char mark = whole[at];
    std::ranges::remove_copy(whole, std::back_inserter(plain), mark);
    std::string grouped = with_thousands(plain);
    std::ranges::replace(grouped, ',', mark);
    const bool unmistakable = plain.size() + 2 <= point || point < text.size() || mark == '\'';
    if (grouped != whole || !std::ranges::all_of(plain, is_digit) || !unmistakable) return false;
    whole = plain;
  }
  std::array<char, kLongestNumber> buffer;
  char* end = std::ranges::copy(whole, buffer.data()).out;
  if (point < text.size()) *end++ = '.';
  end = std::ranges::copy(text.substr(std::min(point + 1, text.size())), end).out;
  if (parse_number(buffer.data(), end, value) != end) return false;
  if (negative) value = -value;
  return true;
}

bool is_missing_value(std::string_view text) {
  return is_word_of("nan -nan inf -inf +inf 1.#qnan n/a na null none -", lower_ascii(trimmed(text)));
}

bool is_of_a_clock(std::string_view field) { return has_date(field) || parse_clock_time(field); }

double RowTimes::examine(const std::vector<std::string_view>& fields) {
  clock_ = !fields.empty() && !parse_number_time(fields.front(), decimal_) && parse_clock_time(fields.front());
  has_date_ = clock_ && has_date(fields.front());
  std::vector<double> steps;
  std::optional<TableTime> last;
  std::size_t intervals = 0;  // also those without a step
  for (const std::string_view field : fields) {
    const auto time = parse(field);
    if (!time) break;
    const double step = last ? since(*time, *last) : -1.0;
    if (step > 0.0) steps.push_back(step);
    if (step >= 0.0) ++intervals;
    last = time;
  }
  if (steps.empty()) return 0.0;
  return nth_smallest(steps, steps.size() / 2) * static_cast<double>(steps.size()) / static_cast<double>(intervals);
}

std::optional<TableTime> RowTimes::parse(std::string_view field) const {
  return clock_ ? parse_clock_time(field) : parse_number_time(field, decimal_);
}

std::optional<double> RowTimes::since_first(std::string_view field) {
  auto time = parse(field);
  if (!time) return std::nullopt;
  if (!first_) first_ = time;
  time->whole += midnights_ * kDay_s;
  if (clock_ && !has_date_ && last_ - since(*time, *first_) > 0.5 * static_cast<double>(kDay_s)) {
    ++midnights_;
    time->whole += kDay_s;
  }
  return last_ = since(*time, *first_);
}

RepeatedTimes find_repeated_times(const std::vector<RecordingRow>& rows) {
  RepeatedTimes found;
  std::vector<Group> groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i].time_s != rows[i - 1].time_s) {
      groups.push_back({rows[i].time_s, 1.0});
      continue;
    }
    groups.back().rows += 1.0;
    ++found.rows;
    found.copies =
        found.copies && rows[i].position_m == rows[i - 1].position_m && rows[i].force_N == rows[i - 1].force_N;
  }
  if (found.rows == 0 || groups.size() < kLeastTimes) return found;
  std::vector<double> steps_s, counts;
  double inner_rows = 0.0;
  for (std::size_t i = 1; i + 1 < groups.size(); ++i) {
    counts.push_back(groups[i].rows);
    steps_s.push_back(groups[i + 1].time_s - groups[i].time_s);
    inner_rows += groups[i].rows;
  }
  found.step_s = nth_smallest(steps_s, steps_s.size() / 2);
  found.mean_rate_Hz = inner_rows / (groups.back().time_s - groups[1].time_s);
  // The rows between two changes of the time are known to one row.
  const double whole_Hz = std::round(found.mean_rate_Hz);
  if (std::abs(whole_Hz - found.mean_rate_Hz) * inner_rows <= 2.0 * found.mean_rate_Hz) found.mean_rate_Hz = whole_Hz;
  const double mean_rows = inner_rows / static_cast<double>(counts.size());
  const bool even = mean_rows >= kLeastRows && is_regular(counts, mean_rows, std::max(1.0, kJitter * mean_rows)) &&
                    is_regular(steps_s, found.step_s, kJitter * found.step_s) &&
                    *std::ranges::max_element(steps_s) <= kPauseSteps * found.step_s;
  if (even) found.rate_Hz = found.mean_rate_Hz;
  return found;
}

}  // namespace palpate
