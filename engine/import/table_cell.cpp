#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// Longer cells are no numbers; doubles written out take at most 24 characters.
constexpr std::size_t kLongestNumber = 64;
constexpr std::int64_t kDay_s = 86400;
// The step of the times is the median of at most so many.
constexpr std::size_t kStepRows = 2000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

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

// Parses and removes a date at the start of `text`.
bool parse_date(std::string_view& text, bool day_first, std::int64_t& days) {
  constexpr std::string_view kMonths = "janfebmaraprmayjunjulaugsepoctnovdec";
  std::string_view rest = text;
  std::array<int, 3> parts{};
  if (!parse_digits(rest, 4, parts[0])) return false;
  const std::string_view mark = rest.substr(0, 1);
  if (!skip_one_of(rest, "-/.")) return false;
  const std::size_t month = rest.size() < 3 ? kMonths.size() : kMonths.find(lower_ascii(rest.substr(0, 3)));
  const bool named = month < kMonths.size() && month % 3 == 0;
  if (named) rest.remove_prefix(3);
  if (named) parts[1] = static_cast<int>(month / 3) + 1;
  if ((!named && !parse_digits(rest, 2, parts[1])) || !skip_one_of(rest, mark) || !parse_digits(rest, 4, parts[2]))
    return false;
  if (parts[0] < 32) {
    if (!day_first && !named) std::swap(parts[0], parts[1]);
    std::swap(parts[0], parts[2]);
  }
  if (parts[0] < 32 || parts[1] < 1 || parts[1] > 12 || parts[2] < 1 || parts[2] > 31) return false;
  // Days since 1970; the library's calendar takes the 31st of every month.
  days = (std::chrono::sys_days(std::chrono::year(parts[0]) / parts[1] / 1).time_since_epoch()).count() + parts[2] - 1;
  text = rest;
  return true;
}

bool has_date(std::string_view text) {
  text = trimmed(text);
  std::int64_t days = 0;
  return parse_date(text, true, days) || parse_date(text, false, days);
}

// Removes the days of a duration: "0 days 00:00:01.5".
bool skip_days(std::string_view& text, std::int64_t& days) {
  std::string_view rest = text;
  int count = 0;
  if (!parse_digits(rest, 4, count) || !rest.starts_with(" day")) return false;
  rest.remove_prefix(rest.starts_with(" days") ? 5 : 4);
  text = trimmed(rest);
  days = count;
  return true;
}

// "Z", "UTC", "+01:00", "-0500"; the seconds before UTC.
std::optional<std::int64_t> parse_time_zone(std::string_view text) {
  if (text.empty() || text == "Z" || text == "UTC") return 0;
  const std::int64_t sign = text.front() == '-' ? -1 : 1;
  int hours = 0, minutes = 0;
  if (!skip_one_of(text, "+-") || !parse_digits(text, 2, hours)) return std::nullopt;
  skip_one_of(text, ":");
  if (!text.empty() && (!parse_digits(text, 2, minutes) || !text.empty())) return std::nullopt;
  return sign * (3600 * hours + 60 * minutes);
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
    const bool unmistakable = plain.size() + 2 <= point || point < text.size() || mark == '\'' || mark == ' ';
    if (grouped != whole || !std::ranges::all_of(plain, is_digit) || !unmistakable) return false;
    whole = plain;
  }
  std::array<char, kLongestNumber> buffer;
  char* end = std::ranges::copy(whole, buffer.data()).out;
  if (point < text.size()) *end++ = '.';
  end = std::ranges::copy(text.substr(std::min(point + 1, text.size())), end).out;
  std::ranges::replace_if(
      buffer.data(), end, [](char c) { return c == 'D' || c == 'd'; }, 'e');  // of Fortran
  if (parse_number(buffer.data(), end, value) != end) return false;
  if (negative) value = -value;
  return true;
}

std::optional<TableCell> parse_table_cell(std::string_view text, char decimal) {
  TableCell cell;
  if (parse_table_number(text, decimal, cell.value)) return cell;
  text = trimmed(text);
  const std::size_t end = text.find_last_of("0123456789.,");
  if (end + 1 >= text.size() || !parse_table_number(text.substr(0, end + 1), decimal, cell.value)) return std::nullopt;
  cell.unit = find_unit(text.substr(end + 1));
  return cell.unit ? std::optional(cell) : std::nullopt;
}

bool is_missing_value(std::string_view text) {
  return is_word_of(
      "nan -nan inf -inf +inf 1.#qnan n/a #n/a na null none nil - -- --- ---- ----- ol ovl ovld ovr over "
      "overload error err",
      lower_ascii(trimmed(text)));
}

namespace {

// A whole number and a fraction, so that nanoseconds since 1970 keep their digits.
struct Time {
  std::int64_t whole = 0;
  double fraction = 0.0;
};
double since(const Time& time, const Time& first) {
  return static_cast<double>(time.whole - first.whole) + (time.fraction - first.fraction);
}

// A plain number as a time.
std::optional<Time> parse_plain_time(std::string_view text, char decimal) {
  Time time;
  text = trimmed(text);
  const auto whole = std::from_chars(text.data(), text.data() + text.size(), time.whole);
  const std::string_view rest = text.substr(static_cast<std::size_t>(whole.ptr - text.data()));
  if (whole.ec == std::errc() && rest.empty()) return time;
  if (whole.ec == std::errc() && time.whole > 0 && rest.front() == decimal &&
      rest.find_first_not_of("0123456789", 1) == std::string_view::npos) {
    parse_table_number(std::string("0").append(rest), decimal, time.fraction);
    return time;
  }
  const auto cell = parse_table_cell(text, decimal);
  constexpr double kLargest = 9e18;  // fits in 64 bits
  if (!cell || std::abs(cell->value) > kLargest) return std::nullopt;
  return Time{static_cast<std::int64_t>(std::floor(cell->value)), cell->value - std::floor(cell->value)};
}

std::optional<Time> parse_clock(std::string_view text, bool day_first) {
  text = trimmed(text);
  std::int64_t days = 0;
  if (parse_date(text, day_first, days)) {
    if (!skip_one_of(text, "T ")) return std::nullopt;
    text = trimmed(text);
  } else {
    skip_days(text, days);
  }
  int first = 0, second = 0, third = 0;
  if (!parse_digits(text, 4, first) || !skip_one_of(text, ":") || !parse_digits(text, 2, second) || second > 59)
    return std::nullopt;
  const bool has_hours = skip_one_of(text, ":");
  if (has_hours && (!parse_digits(text, 2, third) || third > 60)) return std::nullopt;
  Time time;
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
  const auto zone_s = parse_time_zone(trimmed(text));
  time.whole -= zone_s.value_or(0);
  return zone_s ? std::optional(time) : std::nullopt;
}

}  // namespace

bool is_of_a_clock(std::string_view field) {
  return has_date(field) || parse_clock(field, true) || parse_clock(field, false);
}

void ColumnTimes::measure_steps() {
  std::vector<double> steps;
  std::size_t intervals = 0;  // also those without a step
  double last = std::nan("");
  for (const double time : since_first) {
    if (!std::isfinite(time) || intervals == kStepRows) continue;
    if (time > last) steps.push_back(time - last);
    if (time >= last) ++intervals;
    last = time;
  }
  if (steps.empty()) return;
  plain_step = nth_smallest(steps, steps.size() / 2);
  const auto count = static_cast<double>(steps.size());
  steady = std::abs(std::accumulate(steps.begin(), steps.end(), 0.0) / count / plain_step - 1.0) < 1e-3;
  median_step = plain_step * count / static_cast<double>(intervals);
}

Result<ColumnTimes> read_times(const Fields& cells, char decimal) {
  ColumnTimes times;
  const auto first =
      std::ranges::find_if(cells, [](std::string_view cell) { return !cell.empty() && !is_missing_value(cell); });
  times.since_first.reserve(cells.size());
  times.of_a_clock = first != cells.end() && !parse_plain_time(*first, decimal) && is_of_a_clock(*first);
  times.with_dates = times.of_a_clock && has_date(*first);
  const auto parse = [&](std::string_view cell, bool day_first) {
    return times.of_a_clock ? parse_clock(cell, day_first) : parse_plain_time(cell, decimal);
  };
  // The order of day and month in which the most cells are dates; of two the one in which the recording is shorter.
  std::array<std::pair<std::size_t, double>, 2> quality{};  // cells that are no time, duration
  for (const bool day_first : {true, false}) {
    std::optional<Time> begin, end;
    for (std::size_t i = 0; times.with_dates && i < cells.size(); ++i) {
      const auto time = parse(cells[i], day_first);
      if (!time) ++quality[day_first].first;
      if (time) end = time;
      if (!begin) begin = time;
    }
    if (begin) quality[day_first].second = std::abs(since(*end, *begin));
  }
  const bool day_first = quality[true] <= quality[false];
  std::optional<Time> start;
  double last = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto time = parse(cells[i], day_first);
    times.since_first.push_back(std::nan(""));
    if (!time) {
      // Cells with digits that are neither text between the rows nor damaged: all are like the first one.
      if (start || cells[i].find_first_of("0123456789") == std::string_view::npos) continue;
      return Error{"found the time \"" + printable(cells[i]) +
                   "\", which is no number and no time that is understood; write seconds (0.010), or "
                   "hours:minutes:seconds with a decimal mark (14:03:22.010), or, if the rows are evenly spaced, add "
                   "--rate HZ"};
    }
    if (!start) times.first_cell = static_cast<double>(time->whole) + time->fraction, start = time;
    times.whole = times.whole && time->fraction == 0.0;
    double now = since(*time, *start) + static_cast<double>(times.midnights * kDay_s);
    if (times.of_a_clock && !times.with_dates && last - now > 0.5 * static_cast<double>(kDay_s)) {
      ++times.midnights;
      now += static_cast<double>(kDay_s);
    }
    times.since_first.back() = last = now;
  }
  times.measure_steps();
  return times;
}

}  // namespace palpate
