#include "engine/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <cassert>
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

}  // namespace

const char* parse_recording_number(const char* begin, const char* end, double& value) {
  const char* at = parse_number(skip_blanks(begin, end), end, value);
  if (at == nullptr) return nullptr;
  at = skip_blanks(at, end);
  return at == end || *at == ',' ? at : nullptr;
}

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

Result<RecordingReader> RecordingReader::open(const std::string& path) {
  auto file = open_plain_file(path, "a recording (CSV)");
  if (!file) return file.error();
  return from(std::move(*file), path);
}

Result<RecordingReader> RecordingReader::from(std::unique_ptr<std::istream> stream, std::string label) {
  LineScanner scanner(std::move(stream), std::move(label));
  CsvLine line;
  while (scanner.next(line)) {
    if (line.text.starts_with('#')) continue;
    auto header = parse_recording_header(scanner, line);
    if (!header) return header.error();
    return RecordingReader(std::move(scanner), std::move(*header));
  }
  if (scanner.error()) return *scanner.error();
  const std::string found = scanner.lines() == 0 ? "an empty file" : "the end of the file";
  return scanner.error_at(scanner.lines() + 1, 1,
                          "found " + found +
                              ", expected a header row with time_s, position_m and force_N; "
                              "check that the recording was saved");
}

RecordingReader::RecordingReader(LineScanner scanner, RecordingHeader header)
    : name_(std::filesystem::path(scanner.label()).stem().string()),
      scanner_(std::move(scanner)),
      header_(std::move(header)) {
  const auto time = std::find(header_.roles.begin(), header_.roles.end(), ColumnRole::kTime);
  time_index_ = static_cast<std::size_t>(time - header_.roles.begin());
}

RecordingColumns RecordingReader::columns() const {
  const auto has = [this](ColumnRole role) {
    return std::find(header_.roles.begin(), header_.roles.end(), role) != header_.roles.end();
  };
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
  const auto field = std::find(header_.roles.begin(), header_.roles.end(), fault.role);
  const auto index = static_cast<std::size_t>(field - header_.roles.begin());
  return fail(scanner_.error_at(line.number, field_column(line.text, index), fault.text));
}

// Parses every field of one row. If false, `explain_recording_row` gives the reason.
bool RecordingReader::parse(std::string_view text, RecordingRow& row) const {
  std::array<double, kKnownColumns> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  const std::size_t count = header_.roles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ColumnRole role = header_.roles[i];
    at = role == ColumnRole::kIgnored ? find_comma(at, end)
                                      : parse_recording_number(at, end, values[static_cast<std::size_t>(role)]);
    if (at == nullptr) return false;
    const bool is_last = i + 1 == count;
    if (is_last != (at == end)) return false;
    if (!is_last) ++at;
  }
  row = {values[0], values[1], values[2], values[3], values[4]};
  return true;
}

// Blank lines are allowed at the end of the file only.
bool RecordingReader::skip_last_blank_lines(const CsvLine& blank) {
  const std::uint64_t number = blank.number;
  CsvLine line;
  while (scanner_.next(line)) {
    if (trimmed(line.text).empty()) continue;
    return fail(scanner_.error_at(number, 1,
                                  "found a blank line, expected a row with " + std::to_string(header_.roles.size()) +
                                      " fields; remove the blank line"));
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
  if (!parse(line.text, row)) {
    if (trimmed(line.text).empty()) return skip_last_blank_lines(line);
    return fail(explain_recording_row(scanner_, line, header_));
  }
  if (first_row_line_ == 0) {
    first_row_line_ = line.number;
    first_row_time_column_ = field_column(line.text, time_index_);
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
