#include "engine/base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace palpate {
namespace {

// The largest double has 309 digits before the point.
std::string formatted(double value, std::chars_format format, int decimals) {
  std::array<char, 440> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, decimals).ptr;
  return {text.data(), end};
}

}  // namespace

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
