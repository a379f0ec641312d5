// Reads a file of another program as text, and splits it.
#include <algorithm>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// The largest table, which is read as a whole: six million rows, as many as are checked and fitted, of 89 bytes.
constexpr std::size_t kLargestTableBytes = std::size_t{512} << 20;
// Bytes that determine the encoding; the names of the columns are at the beginning.
constexpr std::size_t kEncodingSampleBytes = 64 * 1024;

std::string_view unquoted(std::string_view field) {
  field = trimmed(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    return trimmed(field.substr(1, field.size() - 2));
  return field;
}

// UTF-8 of Latin-1 (`width` 1) or UTF-16 (2). Characters beyond the basic plane, which are no part of numbers, are '?'.
std::string decoded(std::string_view bytes, std::size_t width, bool big_endian) {
  std::string out;
  for (std::size_t i = 0; i + width <= bytes.size(); i += width) {
    const unsigned first = static_cast<unsigned char>(bytes[i]);
    const unsigned second = width > 1 ? static_cast<unsigned char>(bytes[i + 1]) : 0;
    unsigned code = big_endian ? first << 8 | second : second << 8 | first;
    if (code >= 0xD800 && code < 0xE000) code = '?';
    if (code >= 0x800) out += static_cast<char>(0xE0 | code >> 12);
    if (code >= 0x80) out += static_cast<char>(code >= 0x800 ? 0x80 | (code >> 6 & 0x3F) : 0xC0 | code >> 6);
    out += static_cast<char>(code >= 0x80 ? 0x80 | (code & 0x3F) : code);
  }
  return out;
}

// Replaces every `from`, which is not shorter than `to`, a single character.
void replace_all(std::string& text, std::string_view from, char to) {
  std::size_t kept = text.find(from);
  for (std::size_t i = kept; i < text.size();) {
    const bool here = text.compare(i, from.size(), from) == 0;
    text[kept++] = here ? to : text[i];
    i += here ? from.size() : 1;
  }
  text.resize(std::min(kept, text.size()));
}

// Makes the times of arrival that a serial terminal puts before each line ("12:30:01.5 -> ") a column of the table.
void split_off_arrivals(std::string& text) {
  constexpr std::string_view kMark = " -> ";
  const std::string_view sample = std::string_view(text).substr(0, kEncodingSampleBytes);
  std::size_t with = 0, all = 0;
  for (const std::string_view line : lines_of(sample)) {
    const std::size_t mark = line.find(kMark);
    if (!trimmed(line).empty()) ++all;
    if (mark != std::string_view::npos && is_of_a_clock(line.substr(0, mark))) ++with;
  }
  if (with < 2 || 2 * with <= all) return;
  const std::size_t mark = std::min(sample.find_first_of("\t;"), sample.find(','));
  replace_all(text, kMark, mark < sample.size() ? sample[mark] : ' ');
}

Error wrong_kind(const std::string& path, const char* found, const char* advice) {
  return Error{path + ": found " + found + ", expected a table as text (CSV, TXT); " + advice};
}

}  // namespace

std::vector<std::string_view> lines_of(std::string_view text) {
  const auto feeds = std::ranges::count(text, '\n');
  const char end =
      2 * feeds < std::ranges::count(text, '\r') ? '\r' : '\n';  // CR alone, or also with one LF at the end
  std::vector<std::string_view> lines;
  lines.reserve(static_cast<std::size_t>(feeds) + 1);
  while (!text.empty()) {
    const std::size_t at = text.find(end);
    std::string_view line = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    while (line.ends_with('\r')) line.remove_suffix(1);
    while (line.starts_with('\n')) line.remove_prefix(1);
    lines.push_back(line);
  }
  return lines;
}

std::size_t split_table_fields(std::string_view line, const Delimiter& delimiter, Fields& fields) {
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
    foreign = {decoded(std::string_view(bytes).substr(2), 2, big_endian), "UTF-16"};
  } else if (utf8_bytes(sample) + (sample.size() < bytes.size() ? 3 : 0) < sample.size()) {
    // Up to three bytes of a sequence that is cut by the end of the sample are not an error.
    foreign = {decoded(bytes, 1, false), "Latin-1"};
  } else {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    foreign.text = std::move(bytes);
  }
  if (std::string_view(foreign.text).substr(0, kEncodingSampleBytes).find('\0') != std::string_view::npos)
    return wrong_kind(path, "a binary file", "export it as CSV from the program that wrote it");
  for (const std::string_view minus : {"\xE2\x88\x92", "\xE2\x80\x93"}) replace_all(foreign.text, minus, '-');
  for (const std::string_view blank : {"\xC2\xA0", "\xE2\x80\xAF"}) replace_all(foreign.text, blank, ' ');
  split_off_arrivals(foreign.text);
  return foreign;
}

}  // namespace palpate
