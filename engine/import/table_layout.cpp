#include "engine/import/table_layout.h"

#include <algorithm>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/whole_file.h"
#include "engine/import/table_cell.h"

namespace palpate {
namespace {

// The largest table, which is read as a whole: six million rows, as many as are checked and fitted, of 89 bytes.
constexpr std::size_t kLargestTableBytes = std::size_t{512} << 20;
// Preambles of testing machines are some hundred lines long at most.
constexpr std::size_t kSampleLines = 2000;
constexpr std::size_t kSampleBytes = 1024 * 1024;
// A run of rows begins with at most this many short lines of a preamble.
constexpr std::size_t kMostShortRows = 5;
// Fewer rows with more fields than the others are damaged or have remarks.
constexpr std::size_t kRowsOfAWidth = 5;

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

// Whether a field begins like a number and is none, which indicates a wrong reading.
bool is_mangled(std::string_view field) {
  return field.find_first_of("0123456789") < 2 &&
         field.find_first_not_of("0123456789.,;+-eE \t") == std::string_view::npos;
}

// The table for one combination of separator and decimal mark.
struct Reading {
  TableLayout layout;
  std::size_t first = 0;  // index of its first line in the sample
  std::size_t rows = 0, numbers = 0, mangled = 0;
  std::size_t widest = 0;  // fields of the widest row that is no exception

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
  double value = 0.0;
  const auto is_number = [&](std::string_view field) {
    return parse_table_number(field, decimal, value) || is_missing_value(field) || is_of_a_clock(field);
  };
  for (std::size_t i = 0; i < lines.size();) {
    Reading run;
    run.first = i;
    std::vector<std::size_t> counts;  // rows by their number of fields, empty ones included
    std::vector<std::size_t> filled;  // rows by their last field with a value
    std::vector<std::size_t> widths;  // the last field with a value in the rows of each number of fields
    for (; i < lines.size(); ++i) {
      if (trimmed(lines[i]).empty()) continue;
      const std::size_t count = split_table_fields(lines[i], delimiter, fields);
      const std::size_t numbers = count_if(is_number);
      const std::size_t empty = count_if([](std::string_view field) { return field.empty(); });
      if (numbers < 2 || 2 * numbers < fields.size() - empty) break;
      if (count >= counts.size())
        for (auto* list : {&counts, &filled, &widths}) list->resize(count + 1);
      ++counts[count];
      ++filled[fields.size()];
      widths[count] = std::max(widths[count], fields.size());
      ++run.rows;
      run.numbers += numbers;
      run.mangled += count_if([&](std::string_view field) { return is_mangled(field) && !is_number(field); });
    }
    if (run.rows > 0) {
      run.layout.columns = widths[static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin())];
      run.widest = filled.size() - 1;
      while (filled[run.widest] < kRowsOfAWidth && run.widest > run.layout.columns) --run.widest;
    }
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
    return split_table_fields(line, reading.layout.delimiter, fields) < reading.layout.columns;
  };
  const std::size_t last = std::min(lines.size() - 1, reading.first + kMostShortRows);
  while (reading.first < last && is_short(lines[reading.first])) ++reading.first;
  reading.layout.data_line = reading.first + 1;
  reading.layout.data_offset = static_cast<std::size_t>(lines[reading.first].data() - text.data());
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
    if (fields[0] == "Y_Unit_Label") {
      layout.units = fields;
      layout.units[0] = {};
    }
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

// Bytes that determine the encoding; the names of the columns are at the beginning.
constexpr std::size_t kEncodingSampleBytes = 64 * 1024;

void append_utf8(std::string& out, unsigned code) {
  constexpr unsigned kLead[] = {0, 0xC0, 0xE0, 0xF0};  // by the number of bytes that follow
  const int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  out += static_cast<char>(kLead[more] | code >> (6 * more));
  for (int i = more; i-- > 0;) out += static_cast<char>(0x80 | (code >> (6 * i) & 0x3F));
}

std::string decode_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const unsigned first = static_cast<unsigned char>(bytes[i]);
    const unsigned second = static_cast<unsigned char>(bytes[i + 1]);
    return big_endian ? first << 8 | second : second << 8 | first;
  };
  std::string out;
  out.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    unsigned code = unit(i);
    const bool is_high = code >= 0xD800 && code < 0xDC00;
    if (is_high && i + 3 < bytes.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    }
    append_utf8(out, code);
  }
  return out;
}

Error wrong_kind(const std::string& path, const char* found, const char* advice) {
  return Error{path + ": found " + found + ", expected a table as text (CSV, TXT); " + advice};
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

std::size_t split_table_fields(std::string_view line, const Delimiter& delimiter,
                               std::vector<std::string_view>& fields) {
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
  const std::size_t count = fields.size();
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return count;
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
  find_table_header(lines, best.first, best.widest, best.layout);
  read_labview_head(text, best.layout);
  if (best.layout.decimal == ',' && !given_decimal) {
    if (const Status status = check_decimal_comma(best, lines); !status) return status.error();
  }
  return best.layout;
}

Result<ForeignText> read_foreign_text(const std::string& path) {
  auto file = read_plain_file(path, "a table as text (CSV, TXT)", "", kLargestTableBytes);
  if (!file) return file.error();
  std::string& bytes = *file;
  if (bytes.empty()) return wrong_kind(path, "an empty file", "check that the recording was saved");
  if (bytes.starts_with("PK\x03\x04") || bytes.starts_with("\xD0\xCF\x11\xE0"))
    return wrong_kind(path, "an Excel workbook or another archive", "save the sheet as CSV");
  const std::string_view sample = std::string_view(bytes).substr(0, kEncodingSampleBytes);
  const bool big_endian = bytes.starts_with("\xFE\xFF");
  ForeignText foreign;
  if (big_endian || bytes.starts_with("\xFF\xFE")) {
    foreign = {decode_utf16(std::string_view(bytes).substr(2), big_endian), "UTF-16"};
  } else if (utf8_bytes(sample) + (sample.size() < bytes.size() ? 3 : 0) < sample.size()) {
    // Up to three bytes of a sequence that is cut by the end of the sample are not an error.
    foreign.encoding = "Latin-1";
    for (const char c : bytes) append_utf8(foreign.text, static_cast<unsigned char>(c));
  } else {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    foreign.text = std::move(bytes);
  }
  if (std::string_view(foreign.text).substr(0, kEncodingSampleBytes).find('\0') != std::string_view::npos)
    return wrong_kind(path, "a binary file", "export it as CSV from the program that wrote it");
  return foreign;
}

}  // namespace palpate
