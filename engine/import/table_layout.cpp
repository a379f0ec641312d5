#include "engine/import/table_layout.h"

#include <algorithm>
#include <array>

#include "engine/base/text.h"
#include "engine/import/table_cell.h"
#include "engine/import/units.h"

namespace palpate {
namespace {

// Preambles of testing machines are some hundred lines long at most.
constexpr std::size_t kSampleLines = 2000;
constexpr std::size_t kSampleBytes = 1024 * 1024;
// A header is at most this many lines above the numbers: units, a type, a rule may follow it.
constexpr std::size_t kHeaderReach = 6;
// In the order in which they are tried.
constexpr std::array kDelimiters = {Delimiter{"tab", "\t"}, Delimiter{"semicolon", ";"}, Delimiter{"comma", ","},
                                    Delimiter{"blanks", " \t"}};

std::vector<std::string_view> sample_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  const bool cut = text.size() > kSampleBytes;
  text = text.substr(0, kSampleBytes);
  while (!text.empty() && lines.size() < kSampleLines) lines.push_back(next_line(text));
  if (cut && text.empty()) lines.pop_back();  // the sample ends inside this line
  return lines;
}

std::string_view unquoted(std::string_view field) {
  field = trimmed(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    return trimmed(field.substr(1, field.size() - 2));
  return field;
}

bool is_cell_of_numbers(std::string_view field, char decimal) {
  double value = 0.0;
  return parse_table_number(field, decimal, value) || is_missing_value(field) || is_of_a_clock(field);
}

// Whether a field begins like a number and is none, which indicates a wrong reading.
bool is_mangled(std::string_view field) {
  return field.find_first_of("0123456789") < 2 &&
         field.find_first_not_of("0123456789.,;+-eE \t") == std::string_view::npos;
}

// The table for one combination of separator and decimal mark.
struct Reading {
  TableLayout layout;
  std::size_t first = 0;  // index of its first line in the sample
  std::size_t rows = 0;
  std::size_t numbers = 0;
  std::size_t mangled = 0;

  bool better_than(const Reading& other) const {
    if ((mangled == 0) != (other.mangled == 0)) return mangled == 0;
    return numbers > other.numbers;
  }
};

Reading read_as(const std::vector<std::string_view>& lines, const Delimiter& delimiter, char decimal) {
  Reading best;
  std::vector<std::string_view> fields;
  const auto count_if = [&](auto&& accepts) {
    return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), accepts));
  };
  const auto is_number = [&](std::string_view field) { return is_cell_of_numbers(field, decimal); };
  for (std::size_t i = 0; i < lines.size();) {
    Reading run;
    run.first = i;
    std::vector<std::size_t> counts;
    for (; i < lines.size(); ++i) {
      if (trimmed(lines[i]).empty()) continue;
      split_table_fields(lines[i], delimiter, fields);
      const std::size_t numbers = count_if(is_number);
      if (numbers < 2 || 2 * numbers < fields.size()) break;
      if (fields.size() >= counts.size()) counts.resize(fields.size() + 1);
      ++counts[fields.size()];
      ++run.rows;
      run.numbers += numbers;
      run.mangled += count_if([&](std::string_view field) { return is_mangled(field) && !is_number(field); });
    }
    run.layout.columns = static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
    if (run.numbers > best.numbers) best = run;
    ++i;
  }
  best.layout.delimiter = delimiter;
  best.layout.decimal = decimal;
  return best;
}

// Skips first lines of a run with fewer fields than the others: they end a preamble ("Rate 1000").
void skip_short_rows(std::string_view text, const std::vector<std::string_view>& lines, Reading& reading) {
  std::vector<std::string_view> fields;
  const auto is_short = [&](std::string_view line) {
    split_table_fields(line, reading.layout.delimiter, fields);
    return fields.size() < reading.layout.columns;
  };
  const std::size_t last = std::min(lines.size(), reading.first + kHeaderReach) - 1;
  while (reading.first < last && is_short(lines[reading.first])) ++reading.first;
  reading.layout.data_line = reading.first + 1;
  reading.layout.data_offset = static_cast<std::size_t>(lines[reading.first].data() - text.data());
}

// Removes the mark of a comment before the names.
std::string_view without_comment_mark(std::string_view line) {
  line = trimmed(line);
  const std::size_t begin = line.find_first_not_of("#%/");
  // "%time" is a name of ROS, and a lone mark is a name of a column of row numbers.
  if (begin == std::string_view::npos || (begin == 1 && line.front() == '%' && line.find_first_of(" \t") > 5))
    return line;
  return trimmed(line.substr(begin));
}

// In a header separated by blanks, joins units in brackets with the name before.
void join_bracketed(std::vector<std::string_view>& fields) {
  std::size_t kept = 0;
  for (const std::string_view field : fields) {
    if (kept > 0 && (field.front() == '[' || field.front() == '(')) {
      std::string_view& last = fields[kept - 1];
      last = std::string_view(last.data(), static_cast<std::size_t>(field.data() + field.size() - last.data()));
    } else {
      fields[kept++] = field;
    }
  }
  fields.resize(kept);
}

void split_at_wide_gaps(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (!(line = trimmed(line)).empty()) {
    const std::size_t end = std::min(line.find("  "), line.find('\t'));
    fields.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end, line.size()));
  }
}

// Splits a line above the table, by the separator of the table or, if that fails, by any one that gives as many fields
// as the table has columns.
bool split_header(std::string_view line, const TableLayout& layout, std::vector<std::string_view>& fields) {
  const std::string_view bare = without_comment_mark(line);
  const bool blanks = layout.delimiter.is_blanks();
  const auto fits = [&] { return blanks ? fields.size() == layout.columns : fields.size() >= layout.columns; };
  for (const std::string_view text : {line, bare}) {
    split_table_fields(text, layout.delimiter, fields);
    if (fits()) return true;
    if (!blanks) continue;
    join_bracketed(fields);
    if (fits()) return true;
    split_at_wide_gaps(text, fields);
    if (fits()) return true;
  }
  for (const Delimiter& other : kDelimiters) {
    split_table_fields(bare, other, fields);
    if (fields.size() == layout.columns) return true;
  }
  return false;
}

// Splits a header of a table of R: the column of row numbers has no name, so the header has one field less.
bool split_header_of_row_names(std::string_view line, const Reading& reading,
                               const std::vector<std::string_view>& lines, std::vector<std::string_view>& fields) {
  double number = 0.0;
  split_table_fields(lines[reading.first], reading.layout.delimiter, fields);
  if (fields.empty() || !parse_table_number(fields.front(), '.', number) || number != 1.0) return false;
  split_table_fields(line, reading.layout.delimiter, fields);
  if (fields.size() + 1 != reading.layout.columns) return false;
  fields.insert(fields.begin(), std::string_view());
  return true;
}

bool is_units_row(const std::vector<std::string_view>& fields) {
  std::size_t units = 0;
  for (const std::string_view field : fields) {
    if (field.empty() || field == "-" || field == "[]" || field == "[-]") continue;
    const bool bracketed = field.size() > 2 && (field.front() == '[' || field.front() == '(');
    if (!find_unit(field) && !bracketed && field.size() > 3) return false;
    if (find_unit(field)) ++units;
  }
  return units >= 2;
}

bool is_names_row(const std::vector<std::string_view>& fields) {
  std::size_t names = 0;
  for (const std::string_view field : fields) {
    double value = 0.0;
    const bool has_letter = std::any_of(field.begin(), field.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
    });
    if (has_letter && !parse_table_number(field, '.', value)) ++names;
  }
  return names >= 2;
}

void find_header(Reading& reading, const std::vector<std::string_view>& lines) {
  TableLayout& layout = reading.layout;
  std::vector<std::string_view> fields;
  std::size_t seen = 0;
  for (std::size_t i = reading.first; i-- > 0 && seen < kHeaderReach;) {
    if (trimmed(lines[i]).empty()) continue;
    ++seen;
    if (!split_header(lines[i], layout, fields) && !split_header_of_row_names(lines[i], reading, lines, fields)) {
      continue;
    }
    fields.resize(layout.columns);
    if (layout.units.empty() && is_units_row(fields)) {
      layout.units = fields;
    } else if (is_names_row(fields)) {
      layout.names = fields;
      layout.header_line = i + 1;
      return;
    }
  }
}

// Text files of LabVIEW have the units of the columns above the table and, if the table has no times, the interval of
// the rows.
void read_labview_head(std::string_view text, TableLayout& layout) {
  std::string_view head = text.substr(0, layout.data_offset);
  std::vector<std::string_view> fields;
  std::string_view step;
  bool times = true;
  while (!head.empty()) {
    split_table_fields(next_line(head), layout.delimiter, fields);
    if (fields.size() < 2) continue;
    if (fields[0] == "Y_Unit_Label") layout.units = fields;
    if (fields[0] == "X_Columns") times = fields[1] != "No";
    if (fields[0] == "Delta_X") step = fields[1];
  }
  double step_s = 0.0;
  if (!times && parse_table_number(step, layout.decimal, step_s) && step_s > 0.0) layout.step_s = step_s;
}

// Whether a comma in the numbers can only be a decimal mark: not followed by exactly three digits, or after a single 0
// or more than three digits.
bool proves_decimal_comma(std::string_view field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string_view::npos) return false;
  std::string_view whole = field.substr(0, comma);
  if (!whole.empty() && (whole.front() == '-' || whole.front() == '+')) whole.remove_prefix(1);
  const std::size_t end = std::min(field.find_first_not_of("0123456789", comma + 1), field.size());
  return end - comma - 1 != 3 || whole.empty() || whole.front() == '0' || whole.size() > 3;
}

Status check_decimal_comma(const Reading& reading, const std::vector<std::string_view>& lines) {
  std::vector<std::string_view> fields;
  std::string_view example;
  for (std::size_t i = reading.first; i < lines.size(); ++i) {
    split_table_fields(lines[i], reading.layout.delimiter, fields);
    for (const std::string_view field : fields) {
      double value = 0.0;
      if (!parse_table_number(field, ',', value) || field.find(',') == std::string_view::npos) continue;
      if (proves_decimal_comma(field)) return {};
      example = field;
    }
  }
  if (example.empty()) return {};
  return Error{"found numbers such as " + std::string(example) +
               ", whose comma may be a decimal mark or a thousands mark; add --decimal comma, or export the "
               "numbers without thousands marks"};
}

}  // namespace

std::string TableLayout::words(std::string_view encoding) const {
  return std::string(delimiter.name) + " between fields, decimal " + decimal_name() + ", " + std::string(encoding) +
         (header_line > 0 ? ", header in line " + std::to_string(header_line) : ", no header") +
         ", numbers from line " + std::to_string(data_line);
}

std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  while (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void split_table_fields(std::string_view line, const Delimiter& delimiter, std::vector<std::string_view>& fields) {
  fields.clear();
  if (delimiter.is_blanks()) line = trimmed(line);
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = begin;
    const std::size_t text = delimiter.is_blanks() ? begin : line.find_first_not_of(" ", begin);
    if (text < line.size() && line[text] == '"') end = std::min(line.find('"', text + 1), line.size());
    end = std::min(line.find_first_of(delimiter.marks, end), line.size());
    fields.push_back(unquoted(line.substr(begin, end - begin)));
    begin = end + 1;
    if (delimiter.is_blanks()) begin = std::min(line.find_first_not_of(delimiter.marks, begin), line.size() + 1);
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
}

Result<TableLayout> find_table_layout(std::string_view text, std::optional<char> given_decimal) {
  const std::vector<std::string_view> lines = sample_lines(text);
  Reading best;
  for (const Delimiter& delimiter : kDelimiters) {
    for (const char decimal : {'.', ','}) {
      if (given_decimal && *given_decimal != decimal) continue;
      if (delimiter.name == "comma" && decimal == ',') continue;
      const Reading reading = read_as(lines, delimiter, decimal);
      if (reading.rows > 0 && (best.rows == 0 || reading.better_than(best))) best = reading;
    }
  }
  if (best.rows == 0) {
    return Error{"found no rows of numbers in the first " + std::to_string(lines.size()) +
                 (lines.size() == 1 ? " line" : " lines") +
                 ", expected a table with columns of time, position and force; export the recording as CSV"};
  }
  skip_short_rows(text, lines, best);
  find_header(best, lines);
  read_labview_head(text, best.layout);
  if (best.layout.decimal == ',' && !given_decimal) {
    if (const Status status = check_decimal_comma(best, lines); !status) return status.error();
  }
  return best.layout;
}

}  // namespace palpate
