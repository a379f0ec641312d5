// The slow side of the recording reader: it parses the header and explains why a row was refused.
#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/recording/recording_reader.h"

namespace palpate {
namespace {

std::vector<std::string_view> fields_of(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = text.find(',', begin);
    fields.push_back(text.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

std::string fields_in_words(std::size_t count) { return std::to_string(count) + (count == 1 ? " field" : " fields"); }

bool is_number(std::string_view text) {
  double value = 0.0;
  return parse_recording_number(text.data(), text.data() + text.size(), value) == text.data() + text.size();
}

// `text` without blanks and one pair of quotes around it.
std::string_view bare(std::string_view text) {
  text = trimmed(text);
  for (const char quote : {'"', '\''}) {
    if (text.size() >= 2 && text.starts_with(quote) && text.ends_with(quote)) {
      return trimmed(text.substr(1, text.size() - 2));
    }
  }
  return text;
}

// "a", "a and b", "a, b and c".
std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

// Names semicolon or tab if it, and not the comma, separates the fields of `text`; otherwise null.
const char* foreign_separator(std::string_view text, std::size_t expected_fields) {
  const auto count = [text](char c) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), c)); };
  if (count(';') + 1 >= expected_fields) return "semicolons";
  if (count('\t') + 1 >= expected_fields) return "tabs";
  return nullptr;
}

std::string separator_fault(const char* separator) {
  return std::string("found ") + separator +
         " between the fields, expected commas; save the file as comma separated with decimal points";
}

Error separator_error(const LineScanner& scanner, const CsvLine& line, const char* separator) {
  return scanner.error_at(line.number, line.text.find_first_of(";\t") + 1, separator_fault(separator));
}

Error missing_columns(const LineScanner& scanner, const CsvLine& line, const std::vector<std::string_view>& names,
                      const std::vector<std::string_view>& missing) {
  // Usually the file is that of another program, so every message recommends the import.
  const auto at = [&](std::size_t column, const std::string& text) {
    return scanner.error_at(line.number, column,
                            text + ", or let palpate import " + scanner.label() + " --out REC.csv do it");
  };
  if (trimmed(line.text).empty()) {
    return scanner.error_at(line.number, 1,
                            "found a blank line, expected a header row with time_s, position_m and force_N; "
                            "remove the blank line");
  }
  if (missing.size() == kRequiredColumns) {
    if (const char* separator = foreign_separator(line.text, kRequiredColumns)) {
      return at(line.text.find_first_of(";\t") + 1, separator_fault(separator));
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const std::string_view wanted : missing) {
      if (lower_ascii(bare(names[i])) != lower_ascii(wanted)) continue;
      return at(field_column(line.text, i), "found column '" + printable(names[i]) + "', expected exactly " +
                                                std::string(wanted) + "; rename the column");
    }
  }
  if (missing.size() == kRequiredColumns && std::all_of(names.begin(), names.end(), is_number)) {
    return at(1,
              "found a row of numbers, expected a header row with time_s, position_m and force_N; "
              "add the header row");
  }
  return at(1, "found columns " + printable(line.text, 80) + ", expected also " + joined(missing) + "; add the column" +
                   (missing.size() > 1 ? "s" : "") + " or rename what holds the values");
}

// The error of a row whose number of fields differs from the header.
Error field_count_error(const LineScanner& scanner, const CsvLine& line, const RecordingHeader& header,
                        std::size_t found) {
  const std::size_t expected = header.roles.size();
  const std::string wanted = ", expected " + std::to_string(expected) + " as in the header; ";
  const std::string text = "found " + fields_in_words(found);
  if (found < expected) {
    const std::size_t end = line.text.size() + 1;
    if (const char* separator = foreign_separator(line.text, expected)) {
      return separator_error(scanner, line, separator);
    }
    if (!line.terminated) {
      return scanner.error_at(line.number, end,
                              text + " where the file ends" + wanted + "the file was cut off, remove its last line");
    }
    if (header.ends_with_comma && found + 1 == expected) {
      return scanner.error_at(line.number, end, text + wanted + "remove the comma at the end of the header");
    }
    return scanner.error_at(line.number, end, text + wanted + "add the missing values or remove the row");
  }
  const std::size_t extra = field_column(line.text, expected);
  if (found == expected + 1 && trimmed(line.text).ends_with(',')) {
    return scanner.error_at(line.number, extra, text + wanted + "remove the comma at the end of the row");
  }
  if (line.text.find('"') != std::string_view::npos) {
    return scanner.error_at(line.number, extra, text + wanted + "remove quotes and the commas inside them");
  }
  return scanner.error_at(line.number, extra,
                          text + wanted +
                              "write decimal points, not commas, and remove fields without a "
                              "column");
}

// Explains why `field` is not a valid number for the column `name`.
std::string number_fault(std::string_view field, std::string_view name) {
  const std::string_view text = trimmed(field);
  const std::string expected = ", expected a finite number in " + std::string(name) + "; ";
  if (text.empty()) return "found an empty field" + expected + "fill in the value or remove the row";
  const std::string found = "found \"" + printable(text) + "\"";
  if (bare(text).size() != text.size()) {
    return "found quotes around " + printable(bare(text)) + expected + "remove the quotes";
  }
  const std::string lower = lower_ascii(text);
  const std::size_t digits = lower.find_first_not_of("+-");
  if (digits != std::string::npos && lower.compare(digits, 2, "0x") == 0) {
    return found + expected + "write it in decimal";
  }
  double value = 0.0;
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(begin, end, value);
  if (parsed.ec == std::errc::result_out_of_range && parsed.ptr == end) {
    return found + expected + "it is beyond what a double can hold, repair the value";
  }
  if (parsed.ec == std::errc() && (text.find(';') != std::string_view::npos)) {
    return found + expected + "separate fields with commas";
  }
  return found + expected + "remove the row or repair the value";
}

}  // namespace

Result<RecordingHeader> parse_recording_header(const LineScanner& scanner, const CsvLine& line) {
  std::size_t bad_offset = 0;
  if (!is_utf8(line.text, bad_offset)) {
    return scanner.error_at(line.number, bad_offset + 1,
                            "found byte " + printable(line.text.substr(bad_offset, 1)) +
                                ", expected UTF-8 text in the header; save the file as UTF-8 CSV");
  }
  const auto names = fields_of(line.text);
  RecordingHeader header;
  std::array<std::size_t, kKnownColumns> seen{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto known = std::find(kColumnNames.begin(), kColumnNames.end(), names[i]);
    const auto role = static_cast<std::size_t>(known - kColumnNames.begin());
    header.roles.push_back(role < kKnownColumns ? static_cast<ColumnRole>(role) : ColumnRole::kIgnored);
    if (role < kKnownColumns && ++seen[role] > 1) {
      return scanner.error_at(
          line.number, field_column(line.text, i),
          "found column " + std::string(names[i]) + " twice, expected it once; remove or rename one of the two");
    }
  }
  std::vector<std::string_view> missing;
  for (std::size_t i = 0; i < kRequiredColumns; ++i) {
    if (seen[i] == 0) missing.push_back(kColumnNames[i]);
  }
  if (!missing.empty()) return missing_columns(scanner, line, names, missing);
  header.ends_with_comma = names.back().empty();
  return header;
}

Error explain_recording_row(const LineScanner& scanner, const CsvLine& line, const RecordingHeader& header) {
  if (line.text.starts_with('#')) {
    return scanner.error_at(line.number, 1,
                            "found a comment after the header, expected a row; move it above the "
                            "header or remove it");
  }
  const auto fields = fields_of(line.text);
  if (fields.size() != header.roles.size()) {
    return field_count_error(scanner, line, header, fields.size());
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (header.roles[i] == ColumnRole::kIgnored || is_number(fields[i])) continue;
    const auto name = kColumnNames[static_cast<std::size_t>(header.roles[i])];
    return scanner.error_at(line.number, field_column(line.text, i), number_fault(fields[i], name));
  }
  return scanner.error_at(line.number, 1, "found a row that cannot be read; remove it");
}

}  // namespace palpate
