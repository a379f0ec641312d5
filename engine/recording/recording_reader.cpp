#include "engine/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include "engine/base/whole_file.h"

namespace palpate {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

const char* skip_blanks(const char* at, const char* end) {
  while (at != end && is_blank(*at)) ++at;
  return at;
}

const char* find_comma(const char* at, const char* end) {
  const void* comma = at == end ? nullptr : std::memchr(at, ',', static_cast<std::size_t>(end - at));
  return comma == nullptr ? end : static_cast<const char*>(comma);
}

// Parses one number with blanks around it. Returns its end (a comma or `end`), or nullptr if there is no finite number.
const char* parse_field(const char* begin, const char* end, double& value) {
  const char* at = parse_number(skip_blanks(begin, end), end, value);
  if (at == nullptr) return nullptr;
  at = skip_blanks(at, end);
  return at == end || *at == ',' ? at : nullptr;
}

// The rest of the file explains why a line was refused: slow, once a file.

std::vector<std::string_view> fields_of(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = text.find(',', begin);
    fields.push_back(text.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

bool is_number(std::string_view text) {
  double value = 0.0;
  return parse_field(text.data(), text.data() + text.size(), value) == text.data() + text.size();
}

// `text` without blanks and one pair of quotes around it.
std::string_view bare(std::string_view text) {
  text = trimmed(text);
  for (const char quote : {'"', '\''}) {
    if (text.size() >= 2 && text.starts_with(quote) && text.ends_with(quote))
      return trimmed(text.substr(1, text.size() - 2));
  }
  return text;
}

// The column (from 1) where field `index` of `text` starts; blanks before a value are skipped.
std::size_t field_column(std::string_view text, std::size_t index) {
  const char* const end = text.data() + text.size();
  const char* at = text.data();
  for (std::size_t i = 0; i < index && at != end; ++i) {
    at = find_comma(at, end);
    if (at != end) ++at;
  }
  const char* const value = skip_blanks(at, end);
  const bool is_empty = value == end || *value == ',';
  return static_cast<std::size_t>((is_empty ? at : value) - text.data()) + 1;
}

// Why a line was refused, and the column.
struct LineFault {
  std::size_t column = 1;
  std::string text;
};

// The fault of a line with semicolons or tabs between at least `fields` fields.
std::optional<LineFault> foreign_separator(std::string_view text, std::size_t fields) {
  for (const auto& [mark, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}}) {
    if (static_cast<std::size_t>(std::count(text.begin(), text.end(), mark)) + 1 < fields) continue;
    return LineFault{text.find(mark) + 1,
                     std::string("found ") + name +
                         " between the fields, expected commas; save the file as comma separated with decimal points"};
  }
  return std::nullopt;
}

LineFault missing_columns(std::string_view text, const std::vector<std::string_view>& names,
                          const std::vector<std::string_view>& missing) {
  if (trimmed(text).empty()) {
    return {1, "found a blank line, expected a header row with time_s, position_m and force_N; remove the blank line"};
  }
  if (missing.size() == kRequiredColumns) {
    if (const auto separator = foreign_separator(text, kRequiredColumns)) return *separator;
    if (std::all_of(names.begin(), names.end(), is_number)) {
      return {1,
              "found a row of numbers, expected a header row with time_s, position_m and force_N; add the header row"};
    }
  }
  std::string all_missing;
  for (const std::string_view wanted : missing) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (lower_ascii(bare(names[i])) != lower_ascii(wanted)) continue;
      return {field_column(text, i), "found column '" + printable(names[i]) + "', expected exactly " +
                                         std::string(wanted) + "; rename the column"};
    }
    all_missing.append(all_missing.empty() ? "" : " and ").append(wanted);
  }
  return {1, "found columns " + printable(text, 80) + ", expected also " + all_missing +
                 "; add what is missing or rename what holds the values"};
}

// The fault of a row that has `found` fields under a header of `expected`.
LineFault field_count_fault(const CsvLine& line, std::size_t found, std::size_t expected, bool header_ends_with_comma) {
  const bool cut_off = found < expected && !line.terminated;
  const char* advice = "write decimal points, not commas, and remove fields without a column";
  if (cut_off) {
    advice = "the file was cut off, remove its last line";
  } else if (found + 1 == expected && header_ends_with_comma) {
    advice = "remove the comma at the end of the header";
  } else if (found < expected) {
    advice = "add the missing values or remove the row";
  } else if (found == expected + 1 && trimmed(line.text).ends_with(',')) {
    advice = "remove the comma at the end of the row";
  } else if (line.text.find('"') != std::string_view::npos) {
    advice = "remove quotes and the commas inside them";
  }
  return {found < expected ? line.text.size() + 1 : field_column(line.text, expected),
          "found " + std::to_string(found) + (found == 1 ? " field" : " fields") +
              (cut_off ? " where the file ends" : "") + ", expected " + std::to_string(expected) +
              " as in the header; " + advice};
}

// Explains why `field` is not a valid number for the column `name`.
std::string number_fault(std::string_view field, std::string_view name) {
  const std::string_view text = trimmed(field);
  const std::string lower = lower_ascii(text);
  const std::size_t digits = std::min(lower.find_first_not_of("+-"), lower.size());
  std::string found = '"' + printable(text) + '"';
  const char* advice = "remove the row or repair the value";
  double value = 0.0;
  if (text.empty()) {
    found = "an empty field";
    advice = "fill in the value or remove the row";
  } else if (bare(text).size() != text.size()) {
    found = "quotes around " + printable(bare(text));
    advice = "remove the quotes";
  } else if (lower.compare(digits, 2, "0x") == 0) {
    advice = "write it in decimal";
  } else if (std::from_chars(lower.data() + digits, lower.data() + lower.size(), value).ec ==
             std::errc::result_out_of_range) {
    advice = "it is beyond what a double can hold, repair the value";
  } else if (text.find(';') != std::string_view::npos) {
    advice = "separate fields with commas";
  }
  return "found " + found + ", expected a finite number in " + std::string(name) + "; " + advice;
}

}  // namespace

Result<RecordingReader> RecordingReader::open(const std::string& path) {
  auto file = open_plain_file(path, "a recording (CSV)");
  if (!file) return file.error();
  return from(std::move(*file), path);
}

Result<RecordingReader> RecordingReader::from(std::unique_ptr<std::istream> stream, std::string label) {
  RecordingReader reader(LineScanner(std::move(stream), std::move(label)));
  if (const Status header = reader.read_header(); !header) return header.error();
  return reader;
}

RecordingReader::RecordingReader(LineScanner scanner)
    : name_(std::filesystem::path(scanner.label()).stem().string()), scanner_(std::move(scanner)) {}

Status RecordingReader::read_header() {
  CsvLine line;
  while (scanner_.next(line)) {
    if (!line.text.starts_with('#')) return parse_header(line);
  }
  if (scanner_.error()) return *scanner_.error();
  const std::string found = scanner_.lines() == 0 ? "an empty file" : "the end of the file";
  return scanner_.error_at(scanner_.lines() + 1, 1,
                           "found " + found +
                               ", expected a header row with time_s, position_m and force_N; "
                               "check that the recording was saved");
}

Status RecordingReader::parse_header(const CsvLine& line) {
  if (const std::size_t good = utf8_bytes(line.text); good < line.text.size()) {
    return scanner_.error_at(line.number, good + 1,
                             "found byte " + printable(line.text.substr(good, 1)) +
                                 ", expected UTF-8 text in the header; save the file as UTF-8 CSV");
  }
  const auto names = fields_of(line.text);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto known = std::find(kColumnNames.begin(), kColumnNames.end(), names[i]);
    const auto role = static_cast<ColumnRole>(known - kColumnNames.begin());  // ignored if the name is unknown
    if (role != ColumnRole::kIgnored && has(role)) {
      return scanner_.error_at(
          line.number, field_column(line.text, i),
          "found column " + std::string(names[i]) + " twice, expected it once; remove or rename one of the two");
    }
    roles_.push_back(role);
  }
  std::vector<std::string_view> missing;
  for (std::size_t i = 0; i < kRequiredColumns; ++i) {
    if (!has(static_cast<ColumnRole>(i))) missing.push_back(kColumnNames[i]);
  }
  header_ends_with_comma_ = names.back().empty();
  if (missing.empty()) return {};
  // Usually the file is that of another program, so every message recommends the import.
  const LineFault fault = missing_columns(line.text, names, missing);
  return scanner_.error_at(line.number, fault.column,
                           fault.text + ", or let palpate import " + scanner_.label() + " --out REC.csv do it");
}

std::size_t RecordingReader::index_of(ColumnRole role) const {
  return static_cast<std::size_t>(std::find(roles_.begin(), roles_.end(), role) - roles_.begin());
}

RecordingColumns RecordingReader::columns() const {
  return {has(ColumnRole::kVelocity), has(ColumnRole::kAcceleration)};
}

bool RecordingReader::fail(Error error) {
  error_ = std::move(error);
  return false;
}

bool RecordingReader::fail(const RowFault& fault, const CsvLine& line) {
  switch (fault.place) {
    case RowFault::Place::kEnd:
      return fail(scanner_.error_at(scanner_.lines() + 1, 1, fault.text));
    case RowFault::Place::kFirstRow:
      return fail(scanner_.error_at(first_row_line_, first_row_time_column_, fault.text));
    case RowFault::Place::kThisRow:
      break;
  }
  return fail(scanner_.error_at(line.number, field_column(line.text, index_of(fault.role)), fault.text));
}

// Parses every field of one row. If false, `explain` gives the reason.
bool RecordingReader::parse(std::string_view text, RecordingRow& row) const {
  std::array<double, kKnownColumns> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  const std::size_t count = roles_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ColumnRole role = roles_[i];
    at = role == ColumnRole::kIgnored ? find_comma(at, end)
                                      : parse_field(at, end, values[static_cast<std::size_t>(role)]);
    if (at == nullptr) return false;
    const bool is_last = i + 1 == count;
    if (is_last != (at == end)) return false;
    if (!is_last) ++at;
  }
  row = {values[0], values[1], values[2], values[3], values[4]};
  return true;
}

Error RecordingReader::explain(const CsvLine& line) const {
  LineFault fault{1, "found a row that cannot be read; remove it"};
  const auto fields = fields_of(line.text);
  if (line.text.starts_with('#')) {
    fault.text = "found a comment after the header, expected a row; move it above the header or remove it";
  } else if (fields.size() != roles_.size()) {
    const auto separator = fields.size() < roles_.size() ? foreign_separator(line.text, roles_.size()) : std::nullopt;
    fault = separator ? *separator : field_count_fault(line, fields.size(), roles_.size(), header_ends_with_comma_);
  } else {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (roles_[i] == ColumnRole::kIgnored || is_number(fields[i])) continue;
      fault = {field_column(line.text, i), number_fault(fields[i], kColumnNames[static_cast<std::size_t>(roles_[i])])};
      break;
    }
  }
  return scanner_.error_at(line.number, fault.column, fault.text);
}

// Blank lines are allowed at the end of the file only.
bool RecordingReader::skip_last_blank_lines(const CsvLine& blank) {
  const std::uint64_t number = blank.number;
  CsvLine line;
  while (scanner_.next(line)) {
    if (trimmed(line.text).empty()) continue;
    return fail(scanner_.error_at(
        number, 1,
        "found a blank line, expected a row with " + std::to_string(roles_.size()) + " fields; remove the blank line"));
  }
  return finish();
}

bool RecordingReader::finish() {
  if (scanner_.error()) return fail(*scanner_.error());
  ended_ = true;
  if (const auto fault = rules_.finish()) return fail(*fault, CsvLine{});
  return false;
}

// Reads the next row; false at the end and on an error.
bool RecordingReader::next(RecordingRow& row) {
  CsvLine line;
  if (!scanner_.next(line)) return finish();
  if (!parse(line.text, row)) return trimmed(line.text).empty() ? skip_last_blank_lines(line) : fail(explain(line));
  if (first_row_line_ == 0) {
    first_row_line_ = line.number;
    first_row_time_column_ = field_column(line.text, index_of(ColumnRole::kTime));
  }
  if (const auto fault = rules_.check(row)) return fail(*fault, line);
  return true;
}

Result<std::size_t> RecordingReader::read(RecordingRow* rows, std::size_t capacity) {
  assert(capacity > 0);
  std::size_t count = 0;
  while (!ended_ && !error_ && count < capacity && next(rows[count])) ++count;
  if (error_) return *error_;
  return count;
}

}  // namespace palpate
