// Reads lines of an untrusted text file in bounded memory, and formats error messages about them.
// Thread guarantee: slow side only; one thread per object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// Limit of the length of a line, bytes; it bounds the memory.
inline constexpr std::size_t kMaximumLineBytes = 64 * 1024;

// One line without its line end; `text` is valid until the next call of `next`.
struct CsvLine {
  std::string_view text;
  std::uint64_t number = 0;  // from 1
  bool terminated = false;   // false: the file ends here without a newline
};

// Splits a stream into lines at LF or CRLF and skips a UTF-8 byte order mark.
class LineScanner {
 public:
  // `label`: the file's name in messages.
  LineScanner(std::unique_ptr<std::istream> stream, std::string label);

  // Reads the next line; false at the end and after an error. Errors (no line can be read after one): UTF-16, a NUL
  // byte, a carriage return inside a line, a line beyond kMaximumLineBytes, a stream that cannot be read.
  bool next(CsvLine& line);

  const std::optional<Error>& error() const { return error_; }
  const std::string& label() const { return label_; }
  // The number of the last line read, 0 before the first.
  std::uint64_t lines() const { return lines_; }

  // "label:line:column: text"; columns count bytes from 1.
  Error error_at(std::uint64_t line, std::size_t column, const std::string& text) const;

 private:
  bool check(std::string_view text);
  bool fail(std::size_t column, const std::string& text);

  std::unique_ptr<std::istream> stream_;
  std::string label_;
  std::string buffer_;  // of the present line
  std::uint64_t lines_ = 0;
  std::optional<Error> error_;
};

// "path:line:column: ", the beginning of a message about the byte at `offset` of `text`; columns count bytes from 1.
std::string position_prefix(const std::string& path, std::string_view text, std::size_t offset);

// `text` without blanks (space, tab) at both ends.
std::string_view trimmed(std::string_view text);

// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view between = ", ");

// `text` with A to Z replaced by a to z.
std::string lower_ascii(std::string_view text);

// The number of bytes at the start of `text` that are well-formed UTF-8. Source: RFC 3629, section 4.
std::size_t utf8_bytes(std::string_view text);

// `text` for a message: bytes that are not printable as \xHH, truncated with "..." after about `limit` bytes.
std::string printable(std::string_view text, std::size_t limit = 40);

// Parses one decimal number at `begin`, '.' as decimal point in every locale, correctly rounded; a leading '+' is
// accepted. Returns its end, or nullptr if there is no finite number.
const char* parse_number(const char* begin, const char* end, double& value);

// The shortest decimal form that reads back as the same double.
std::string shortest(double value);

}  // namespace palpate
