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

// Replaces every `from`; a minus sign of a typesetter is followed by a number.
void replace_all(std::string& text, std::string_view from, char to, bool before_number) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < text.size();) {
    const bool here = text.compare(i, from.size(), from) == 0;
    const std::size_t next = std::min(i + from.size(), text.size());
    if (here && (!before_number || (next < text.size() && std::string_view("0123456789.,").find(text[next]) < 12))) {
      text[kept++] = to;
      i = next;
    } else {
      text[kept++] = text[i++];
    }
  }
  text.resize(kept);
}

// Makes the times of arrival that a serial terminal puts before each line ("12:30:01.5 -> ") a column of the table.
// Returns whether there are any.
bool split_off_arrivals(std::string& text) {
  constexpr std::string_view kMark = " -> ";
  constexpr std::size_t kLines = 50;
  const std::string_view sample = std::string_view(text).substr(0, kEncodingSampleBytes);
  std::size_t with = 0, all = 0;
  for (const std::string_view line : lines_of(sample)) {
    if (trimmed(line).empty() || all == kLines) continue;
    ++all;
    const std::size_t mark = line.find(kMark);
    if (mark != std::string_view::npos && is_of_a_clock(line.substr(0, mark))) ++with;
  }
  if (with < 2 || 2 * with <= all) return false;
  const std::size_t mark = std::min(sample.find_first_of("\t;"), sample.find(','));
  const char separator = mark < sample.size() ? sample[mark] : ' ';
  for (std::size_t at = 0; (at = text.find(kMark, at)) != std::string::npos; ++at)
    text.replace(at, kMark.size(), 1, separator);
  return true;
}

Error wrong_kind(const std::string& path, const char* found, const char* advice) {
  return Error{path + ": found " + found + ", expected a table as text (CSV, TXT); " + advice};
}

}  // namespace

std::vector<std::string_view> lines_of(std::string_view text) {
  const char end = text.find('\n') == std::string_view::npos ? '\r' : '\n';
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t at = text.find(end);
    std::string_view line = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    while (line.ends_with('\r')) line.remove_suffix(1);
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
  for (const std::string_view minus : {"\xE2\x88\x92", "\xE2\x80\x93"})  // U+2212, U+2013
    if (foreign.text.find(minus) != std::string::npos) replace_all(foreign.text, minus, '-', true);
  for (const std::string_view blank : {"\xC2\xA0", "\xE2\x80\xAF"})  // U+00A0, U+202F
    if (foreign.text.find(blank) != std::string::npos) replace_all(foreign.text, blank, ' ', false);
  foreign.has_arrivals = split_off_arrivals(foreign.text);
  return foreign;
}

}  // namespace palpate
