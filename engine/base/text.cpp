#include "engine/base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

namespace palpate {
namespace {

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

// The largest double has 309 digits before the point.
std::string formatted(double value, std::chars_format format, int decimals) {
  std::array<char, 440> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, decimals).ptr;
  return {text.data(), end};
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  return text;
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : between).append(word);
  return text;
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(from, at)) != std::string_view::npos; at = next + from.size())
    result.append(text, at, next - at).append(to);
  return result.append(text, at, std::string_view::npos);
}

std::string lower_ascii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
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
    const bool ends_line = sequence == "\n" && limit == std::string_view::npos;
    if (bytes == 0 || (is_control(sequence) && !ends_line))
      for (const char c : sequence) out += escaped(static_cast<unsigned char>(c));
    else
      out += sequence;
    i += sequence.size();
  }
  return out;
}

std::string position_prefix(const std::string& path, std::string_view text, std::size_t offset) {
  const std::string_view preceding = text.substr(0, offset);
  const std::size_t line_start = preceding.rfind('\n') + 1;  // 0 in the first line
  const auto lines = std::count(preceding.begin(), preceding.end(), '\n') + 1;
  return path + ":" + std::to_string(lines) + ":" + std::to_string(preceding.size() - line_start + 1) + ": ";
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : names) {
    // edits[j]: from the letters of `word` so far to the first j of `name`.
    std::vector<std::size_t> edits(name.size() + 1);
    std::iota(edits.begin(), edits.end(), std::size_t{0});
    for (const char letter : word) {
      std::size_t diagonal = edits[0]++;
      for (std::size_t j = 0; j < name.size(); ++j) {
        const std::size_t replaced = diagonal + (letter == name[j] ? 0 : 1);
        diagonal = edits[j + 1];
        edits[j + 1] = std::min({replaced, diagonal + 1, edits[j] + 1});
      }
    }
    if (edits.back() >= fewest) continue;
    fewest = edits.back();
    nearest = name;
  }
  return nearest;
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=:,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  return '\'' + replaced(text, "'", "'\\''") + '\'';
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

std::string fixed(double value, int decimals) { return formatted(value, std::chars_format::fixed, decimals); }

std::string general(double value, int digits) { return formatted(value, std::chars_format::general, digits); }

std::string with_thousands(const std::string& digits) {
  const std::size_t first = !digits.empty() && digits[0] == '-' ? 1 : 0;
  std::size_t end = digits.find('.');
  if (end == std::string::npos) end = digits.size();
  std::string text;
  for (std::size_t at = 0; at < digits.size(); ++at) {
    if (at > first && at < end && (end - at) % 3 == 0) text.push_back(',');
    text.push_back(digits[at]);
  }
  return text;
}

std::string three_digits(double value) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  if (size >= 1e7 || size < 1e-4) return formatted(value, std::chars_format::scientific, 2);
  // Rounded first, so that 9.999 has as many digits as 10.0.
  const double magnitude = std::pow(10.0, std::floor(std::log10(size)) - 2.0);
  const double rounded = std::round(value / magnitude) * magnitude;
  const int decimals = 2 - static_cast<int>(std::floor(std::log10(std::abs(rounded)) + 1e-12));
  return with_thousands(fixed(rounded, std::max(0, decimals)));
}

std::string at_most_three_decimals(double value) {
  if (!std::isfinite(value)) return "–";
  const double size = std::abs(value);
  // A value that rounds to the next power of ten has one digit more before the point.
  return fixed(value, size < 0.9995 ? 3 : size < 9.995 ? 2 : size < 99.95 ? 1 : 0);
}

}  // namespace palpate
