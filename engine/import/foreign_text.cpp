#include "engine/import/foreign_text.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

// Bytes that determine the encoding; the names of the columns are at the beginning.
constexpr std::size_t kEncodingSampleBytes = 64 * 1024;

void append_utf8(std::string& out, unsigned code) {
  const auto put = [&out](unsigned byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
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

Result<ForeignText> read_foreign_text(const std::string& path) {
  constexpr const char* kExpected = "a table as text (CSV, TXT)";
  std::error_code unknown;
  if (const auto bytes = std::filesystem::file_size(path, unknown); !unknown && bytes > kLargestTableBytes) {
    return Error{path + ": found " + std::to_string(bytes >> 20) + " MiB, expected " + kExpected + " of at most " +
                 std::to_string(kLargestTableBytes >> 20) + " MiB; split the file"};
  }
  auto file = read_plain_file(path, kExpected, "", kLargestTableBytes);
  if (!file) return file.error();
  std::string& bytes = *file;
  if (bytes.empty()) return wrong_kind(path, "an empty file", "check that the recording was saved");
  if (bytes.starts_with("PK\x03\x04") || bytes.starts_with("\xD0\xCF\x11\xE0")) {
    return wrong_kind(path, "an Excel workbook or another archive", "save the sheet as CSV");
  }
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
  if (std::string_view(foreign.text).substr(0, kEncodingSampleBytes).find('\0') != std::string_view::npos) {
    return wrong_kind(path, "a binary file", "export it as CSV from the program that wrote it");
  }
  return foreign;
}

}  // namespace palpate
