#include "engine/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <filesystem>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

// Bytes beyond the longest line that are read: a byte order mark, a carriage return, one byte that shows that the line
// is too long, and the terminator.
constexpr std::size_t kBeyondLimit = 6;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

const char* skip_blanks(const char* at, const char* end) {
  while (at != end && is_blank(*at)) ++at;
  return at;
}

// Parses one number with blanks around it. Returns its end (a comma or `end`), or nullptr if there is no finite number.
const char* parse_field(const char* begin, const char* end, double& value) {
  const char* at = parse_number(skip_blanks(begin, end), end, value);
  if (at == nullptr) return nullptr;
  at = skip_blanks(at, end);
  return at == end || *at == ',' ? at : nullptr;
}

// The functions below explain why a line was refused: slow, once a file.

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.push_back(line.substr(begin, comma - begin));
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
  for (const char quote : {'"', '\''})
    if (text.size() >= 2 && text.starts_with(quote) && text.ends_with(quote))
      return trimmed(text.substr(1, text.size() - 2));
  return text;
}

// The column (from 1) where the value of a field of `line` begins; of a blank field: where the field begins.
std::size_t column_of(std::string_view line, std::string_view field) {
  const std::string_view value = trimmed(field);
  return static_cast<std::size_t>((value.empty() ? field : value).data() - line.data()) + 1;
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
  if (trimmed(text).empty())
    return {1, "found a blank line, expected a header row with time_s, position_m and force_N; remove the blank line"};
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
      return {column_of(text, names[i]), "found column '" + printable(names[i]) + "', expected exactly " +
                                             std::string(wanted) + "; rename the column"};
    }
    all_missing.append(all_missing.empty() ? "" : " and ").append(wanted);
  }
  return {1, "found columns " + printable(text, 80) + ", expected also " + all_missing +
                 "; add what is missing or rename what holds the values"};
}

// The fault of a row that does not have the `expected` number of fields. `has_end`: it ends with a newline.
LineFault field_count_fault(std::string_view line, bool has_end, std::size_t expected, bool header_ends_with_comma) {
  const auto fields = fields_of(line);
  const std::size_t found = fields.size();
  const bool cut_off = found < expected && !has_end;
  const char* advice = "write decimal points, not commas, and remove fields without a column";
  if (cut_off)
    advice = "the file was cut off, remove its last line";
  else if (found + 1 == expected && header_ends_with_comma)
    advice = "remove the comma at the end of the header";
  else if (found < expected)
    advice = "add the missing values or remove the row";
  else if (found == expected + 1 && trimmed(line).ends_with(','))
    advice = "remove the comma at the end of the row";
  else if (line.find('"') != std::string_view::npos)
    advice = "remove quotes and the commas inside them";
  return {found < expected ? line.size() + 1 : column_of(line, fields[expected]),
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

// The fault of a row that cannot be parsed under a header of these columns.
LineFault row_fault(std::string_view line, bool has_end, const std::vector<ColumnRole>& roles,
                    bool header_ends_with_comma) {
  const auto fields = fields_of(line);
  if (line.starts_with('#'))
    return {1, "found a comment after the header, expected a row; move it above the header or remove it"};
  if (fields.size() < roles.size()) {
    if (const auto separator = foreign_separator(line, roles.size())) return *separator;
  }
  if (fields.size() != roles.size()) return field_count_fault(line, has_end, roles.size(), header_ends_with_comma);
  std::size_t bad = 0;
  while (bad + 1 < fields.size() && (roles[bad] == ColumnRole::kIgnored || is_number(fields[bad]))) ++bad;
  return {column_of(line, fields[bad]), number_fault(fields[bad], kColumnNames[static_cast<std::size_t>(roles[bad])])};
}

// The fault of a line of bytes that are no text.
std::optional<LineFault> bytes_fault(std::string_view line) {
  if (const std::size_t nul = line.find('\0'); nul != std::string_view::npos) {
    return LineFault{nul + 1,
                     "found a NUL byte, expected UTF-8 text; this is a binary or UTF-16 file, save it as UTF-8 CSV"};
  }
  if (const std::size_t at = line.find('\r'); at < line.size() - 1) {
    return LineFault{
        at + 1, "found a carriage return inside a line, expected lines that end in LF or CRLF; convert the line ends"};
  }
  if (line.size() > kMaximumLineBytes) {
    return LineFault{kMaximumLineBytes + 1,
                     "found a line longer than " + std::to_string(kMaximumLineBytes) +
                         " bytes, expected a row of a recording; check that this is a CSV file with line ends"};
  }
  return std::nullopt;
}

}  // namespace

Result<RecordingReader> RecordingReader::open(const std::string& path) {
  auto file = open_plain_file(path, "a recording (CSV)");
  if (!file) return file.error();
  return from(std::move(*file), path);
}

Result<RecordingReader> RecordingReader::from(std::unique_ptr<std::istream> stream, std::string label) {
  RecordingReader reader(std::move(stream), std::move(label));
  if (!reader.read_header()) return *reader.error_;
  return reader;
}

RecordingReader::RecordingReader(std::unique_ptr<std::istream> stream, std::string label)
    : stream_(std::move(stream)),
      label_(std::move(label)),
      name_(std::filesystem::path(label_).stem().string()),
      buffer_(kMaximumLineBytes + kBeyondLimit) {}

bool RecordingReader::fail(std::uint64_t line, std::size_t column, const std::string& text) {
  error_ = Error{label_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + text};
  return false;
}

bool RecordingReader::fail(const RowFault& fault) {
  switch (fault.place) {
    case RowFault::Place::kEnd:
      return fail(line_number_ + 1, 1, fault.text);
    case RowFault::Place::kFirstRow:
      return fail(first_row_line_, first_row_time_column_, fault.text);
    case RowFault::Place::kThisRow:
      break;
  }
  return fail(line_number_, column_of(line_, fields_of(line_)[index_of(fault.role)]), fault.text);
}

// Lines end with LF or CRLF; a UTF-8 byte order mark is skipped.
bool RecordingReader::next_line() {
  stream_->getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (stream_->bad()) {
    error_ = unreadable(label_);
    return false;
  }
  // The count includes the line feed, which is not stored.
  const auto count = static_cast<std::size_t>(stream_->gcount());
  line_has_end_ = stream_->good();
  if (count == 0) return false;
  line_ = std::string_view(buffer_.data(), line_has_end_ ? count - 1 : count);
  if (line_number_ == 0) {
    if (line_.starts_with("\xFF\xFE") || line_.starts_with("\xFE\xFF"))
      return fail(1, 1, "found UTF-16 text, expected UTF-8; save the file as UTF-8 CSV");
    if (line_.starts_with("\xEF\xBB\xBF")) line_.remove_prefix(3);
    if (line_.empty() && !line_has_end_) return false;
  }
  ++line_number_;
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  const auto fault = bytes_fault(line_);
  return !fault || fail(line_number_, fault->column, fault->text);
}

bool RecordingReader::read_header() {
  while (next_line())
    if (!line_.starts_with('#')) return parse_header();
  if (error_) return false;
  return fail(line_number_ + 1, 1,
              std::string("found ") + (line_number_ == 0 ? "an empty file" : "the end of the file") +
                  ", expected a header row with time_s, position_m and force_N; check that the recording was saved");
}

bool RecordingReader::parse_header() {
  if (const std::size_t good = utf8_bytes(line_); good < line_.size()) {
    return fail(line_number_, good + 1,
                "found byte " + printable(line_.substr(good, 1)) +
                    ", expected UTF-8 text in the header; save the file as UTF-8 CSV");
  }
  const auto names = fields_of(line_);
  for (const std::string_view name : names) {
    const auto known = std::find(kColumnNames.begin(), kColumnNames.end(), name);
    const auto role = static_cast<ColumnRole>(known - kColumnNames.begin());  // ignored if the name is unknown
    if (role != ColumnRole::kIgnored && has(role)) {
      return fail(line_number_, column_of(line_, name),
                  "found column " + std::string(name) + " twice, expected it once; remove or rename one of the two");
    }
    roles_.push_back(role);
  }
  header_ends_with_comma_ = names.back().empty();
  std::vector<std::string_view> missing;
  for (std::size_t i = 0; i < kRequiredColumns; ++i)
    if (!has(static_cast<ColumnRole>(i))) missing.push_back(kColumnNames[i]);
  if (missing.empty()) return true;
  // Usually the file is that of another program, so every message recommends the import.
  const LineFault fault = missing_columns(line_, names, missing);
  return fail(line_number_, fault.column, fault.text + ", or let palpate import " + label_ + " --out REC.csv do it");
}

std::size_t RecordingReader::index_of(ColumnRole role) const {
  return static_cast<std::size_t>(std::find(roles_.begin(), roles_.end(), role) - roles_.begin());
}

RecordingColumns RecordingReader::columns() const {
  return {has(ColumnRole::kVelocity), has(ColumnRole::kAcceleration)};
}

// Parses every field of the present line. If false, row_fault gives the reason.
bool RecordingReader::parse(RecordingRow& row) const {
  std::array<double, kKnownColumns> values{};
  const char* at = line_.data();
  const char* const end = at + line_.size();
  const std::size_t count = roles_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ColumnRole role = roles_[i];
    at = role == ColumnRole::kIgnored ? std::find(at, end, ',')
                                      : parse_field(at, end, values[static_cast<std::size_t>(role)]);
    if (at == nullptr) return false;
    const bool is_last = i + 1 == count;
    if (is_last != (at == end)) return false;
    if (!is_last) ++at;
  }
  row = {values[0], values[1], values[2], values[3], values[4]};
  return true;
}

// Blank lines are allowed at the end of the file only.
bool RecordingReader::skip_last_blank_lines() {
  const std::uint64_t first = line_number_;
  while (next_line()) {
    if (trimmed(line_).empty()) continue;
    return fail(
        first, 1,
        "found a blank line, expected a row with " + std::to_string(roles_.size()) + " fields; remove the blank line");
  }
  return finish();
}

bool RecordingReader::finish() {
  if (error_) return false;
  ended_ = true;
  const auto fault = rules_.finish();
  return fault && fail(*fault);
}

bool RecordingReader::next(RecordingRow& row) {
  if (!next_line()) return finish();
  if (!parse(row)) {
    if (trimmed(line_).empty()) return skip_last_blank_lines();
    const LineFault fault = row_fault(line_, line_has_end_, roles_, header_ends_with_comma_);
    return fail(line_number_, fault.column, fault.text);
  }
  if (first_row_line_ == 0) {
    first_row_line_ = line_number_;
    first_row_time_column_ = column_of(line_, fields_of(line_)[index_of(ColumnRole::kTime)]);
  }
  const auto fault = rules_.check(row);
  return !fault || fail(*fault);
}

Result<std::size_t> RecordingReader::read(RecordingRow* rows, std::size_t capacity) {
  assert(capacity > 0);
  std::size_t count = 0;
  while (!ended_ && !error_ && count < capacity && next(rows[count])) ++count;
  if (error_) return *error_;
  return count;
}

}  // namespace palpate
