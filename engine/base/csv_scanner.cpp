#include "engine/base/csv_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "engine/base/whole_file.h"

namespace palpate {
namespace {

// Bytes beyond the longest line that are read: a byte order mark, a carriage return, one byte that shows that the line
// is too long, and the terminator.
constexpr std::size_t kBeyondLimit = 6;

// The length of the well-formed UTF-8 sequence at the start of `text`, or 0.
std::size_t utf8_sequence_bytes(std::string_view text) {
  constexpr unsigned kLeastCode[] = {0, 0x80, 0x800, 0x10000};  // a smaller one has a shorter sequence
  const auto byte = [text](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  const unsigned lead = byte(0);
  const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xC0 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF8 ? 4 : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  unsigned code = bytes == 1 ? lead : lead & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (byte(i) >> 6 != 0b10) return 0;
    code = code << 6 | (byte(i) & 0x3F);
  }
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code >= kLeastCode[bytes - 1] && code <= 0x10FFFF && !is_surrogate ? bytes : 0;
}

std::string escaped(unsigned char byte) {
  static constexpr char kDigits[] = "0123456789abcdef";
  return {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

// C0 controls and DEL, and the C1 controls (U+0080 to U+009F), which a terminal may execute, too.
bool is_control(std::string_view sequence) {
  const auto lead = static_cast<unsigned char>(sequence[0]);
  if (sequence.size() == 1) return lead < 0x20 || lead == 0x7F;
  return lead == 0xC2 && static_cast<unsigned char>(sequence[1]) < 0xA0;
}

}  // namespace

LineScanner::LineScanner(std::unique_ptr<std::istream> stream, std::string label)
    : stream_(std::move(stream)), label_(std::move(label)), buffer_(kMaximumLineBytes + kBeyondLimit, '\0') {}

Error LineScanner::error_at(std::uint64_t line, std::size_t column, const std::string& text) const {
  return Error{label_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + text};
}

bool LineScanner::fail(std::size_t column, const std::string& text) {
  error_ = error_at(lines_ + 1, column, text);
  return false;
}

// The rules for any line, the header and comments included.
bool LineScanner::check(std::string_view text) {
  const std::size_t nul = text.find('\0');
  if (nul != std::string_view::npos) {
    return fail(nul + 1,
                "found a NUL byte, expected UTF-8 text; this is a binary or UTF-16 file, save it as UTF-8 CSV");
  }
  const std::size_t carriage_return = text.find('\r');
  if (carriage_return != std::string_view::npos && carriage_return + 1 < text.size()) {
    return fail(carriage_return + 1,
                "found a carriage return inside a line, expected lines that end in LF or CRLF; convert the line ends");
  }
  if (text.size() > kMaximumLineBytes) {
    return fail(kMaximumLineBytes + 1,
                "found a line longer than " + std::to_string(kMaximumLineBytes) +
                    " bytes, expected a row of a recording; check that this is a CSV file with line ends");
  }
  return true;
}

bool LineScanner::next(CsvLine& line) {
  if (error_) return false;
  stream_->getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (stream_->bad()) {
    error_ = unreadable(label_);
    return false;
  }
  // The count includes the line feed, which is not stored.
  const auto count = static_cast<std::size_t>(stream_->gcount());
  line.terminated = stream_->good();
  if (count == 0) return false;
  line.text = std::string_view(buffer_).substr(0, line.terminated ? count - 1 : count);
  if (lines_ == 0) {
    if (line.text.starts_with("\xFF\xFE") || line.text.starts_with("\xFE\xFF")) {
      return fail(1, "found UTF-16 text, expected UTF-8; save the file as UTF-8 CSV");
    }
    if (line.text.starts_with("\xEF\xBB\xBF")) line.text.remove_prefix(3);
    if (line.text.empty() && !line.terminated) return false;
  }
  if (line.text.ends_with('\r')) line.text.remove_suffix(1);
  if (!check(line.text)) return false;
  line.number = ++lines_;
  return true;
}

std::string position_prefix(const std::string& path, std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const std::size_t line_start = before.rfind('\n') + 1;  // 0 in the first line
  const auto lines = std::count(before.begin(), before.end(), '\n') + 1;
  return path + ":" + std::to_string(lines) + ":" + std::to_string(before.size() - line_start + 1) + ": ";
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : between).append(word);
  return text;
}

std::string lower_ascii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::size_t utf8_bytes(std::string_view text) {
  std::string_view rest = text;
  for (std::size_t bytes = 1; !rest.empty() && bytes > 0; rest.remove_prefix(bytes)) bytes = utf8_sequence_bytes(rest);
  return text.size() - rest.size();
}

std::string printable(std::string_view text, std::size_t limit) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (out.size() >= limit) return out + "...";
    const std::size_t bytes = utf8_sequence_bytes(text.substr(i));
    const std::string_view sequence = text.substr(i, std::max<std::size_t>(bytes, 1));
    if (bytes == 0 || is_control(sequence)) {
      for (const char c : sequence) out += escaped(static_cast<unsigned char>(c));
    } else {
      out += sequence;
    }
    i += sequence.size();
  }
  return out;
}

const char* parse_number(const char* begin, const char* end, double& value) {
  // from_chars does not accept '+'; "+-1" must remain an error.
  if (begin != end && *begin == '+' && ++begin != end && *begin == '-') return nullptr;
  const auto parsed = std::from_chars(begin, end, value);
  return parsed.ec == std::errc() && std::isfinite(value) ? parsed.ptr : nullptr;
}

std::string shortest(double value) {
  char text[32];  // the longest double takes 24
  const auto end = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

}  // namespace palpate
