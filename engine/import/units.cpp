#include "engine/import/units.h"

#include <array>

#include "engine/base/csv_scanner.h"

namespace palpate {
namespace {

constexpr double kGramForce_N = 9.80665e-3;  // standard gravity
constexpr double kPoundForce_N = 4.4482216152605;

struct Spelling {
  std::string_view text;
  Unit unit;
};

constexpr Unit kSecond{"s", Quantity::time, 1.0};
constexpr Unit kMillisecond{"ms", Quantity::time, 1e-3};
constexpr Unit kMicrosecond{"us", Quantity::time, 1e-6};
constexpr Unit kNanosecond{"ns", Quantity::time, 1e-9};
constexpr Unit kMinute{"min", Quantity::time, 60.0};
constexpr Unit kMetre{"m", Quantity::length, 1.0};
constexpr Unit kCentimetre{"cm", Quantity::length, 1e-2};
constexpr Unit kMillimetre{"mm", Quantity::length, 1e-3};
constexpr Unit kMicrometre{"um", Quantity::length, 1e-6};
constexpr Unit kNanometre{"nm", Quantity::length, 1e-9};
constexpr Unit kInch{"inch", Quantity::length, 25.4e-3};
constexpr Unit kNewton{"N", Quantity::force, 1.0};
constexpr Unit kMillinewton{"mN", Quantity::force, 1e-3};
constexpr Unit kMicronewton{"uN", Quantity::force, 1e-6};
constexpr Unit kCentinewton{"cN", Quantity::force, 1e-2};
constexpr Unit kKilonewton{"kN", Quantity::force, 1e3};
constexpr Unit kGram{"g", Quantity::force, kGramForce_N};
constexpr Unit kKilogram{"kg", Quantity::force, 1e3 * kGramForce_N};
constexpr Unit kPound{"lbf", Quantity::force, kPoundForce_N};

// The micro sign is U+00B5 or, in some fonts' files, the Greek U+03BC.
constexpr std::array kSpellings = {
    Spelling{"s", kSecond},
    Spelling{"sec", kSecond},
    Spelling{"secs", kSecond},
    Spelling{"second", kSecond},
    Spelling{"seconds", kSecond},
    Spelling{"Sek", kSecond},
    Spelling{"Sekunden", kSecond},
    Spelling{"ms", kMillisecond},
    Spelling{"msec", kMillisecond},
    Spelling{"millis", kMillisecond},
    Spelling{"millisecond", kMillisecond},
    Spelling{"milliseconds", kMillisecond},
    Spelling{"us", kMicrosecond},
    Spelling{"\xC2\xB5s", kMicrosecond},
    Spelling{"\xCE\xBCs", kMicrosecond},
    Spelling{"usec", kMicrosecond},
    Spelling{"micros", kMicrosecond},
    Spelling{"microseconds", kMicrosecond},
    Spelling{"ns", kNanosecond},
    Spelling{"nsec", kNanosecond},
    Spelling{"nanoseconds", kNanosecond},
    Spelling{"min", kMinute},
    Spelling{"minutes", kMinute},
    Spelling{"m", kMetre},
    Spelling{"meter", kMetre},
    Spelling{"meters", kMetre},
    Spelling{"metre", kMetre},
    Spelling{"metres", kMetre},
    Spelling{"cm", kCentimetre},
    Spelling{"mm", kMillimetre},
    Spelling{"millimeter", kMillimetre},
    Spelling{"millimeters", kMillimetre},
    Spelling{"um", kMicrometre},
    Spelling{"\xC2\xB5m", kMicrometre},
    Spelling{"\xCE\xBCm", kMicrometre},
    Spelling{"micron", kMicrometre},
    Spelling{"microns", kMicrometre},
    Spelling{"nm", kNanometre},
    Spelling{"inch", kInch},
    Spelling{"inches", kInch},
    Spelling{"N", kNewton},
    Spelling{"newton", kNewton},
    Spelling{"newtons", kNewton},
    Spelling{"mN", kMillinewton},
    Spelling{"uN", kMicronewton},
    Spelling{"\xC2\xB5N", kMicronewton},
    Spelling{"\xCE\xBCN", kMicronewton},
    Spelling{"cN", kCentinewton},
    Spelling{"kN", kKilonewton},
    Spelling{"g", kGram},
    Spelling{"gf", kGram},
    Spelling{"gram", kGram},
    Spelling{"grams", kGram},
    Spelling{"kg", kKilogram},
    Spelling{"kgf", kKilogram},
    Spelling{"lbf", kPound},
    Spelling{"lb", kPound},
};

constexpr std::string_view kOpening = "[(<{";
constexpr std::string_view kClosing = "])>}";

std::string_view without_brackets(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2) return text;
  const std::size_t kind = kOpening.find(text.front());
  if (kind == std::string_view::npos || text.back() != kClosing[kind]) return text;
  return trimmed(text.substr(1, text.size() - 2));
}

NameAndUnit parts(std::string_view name, std::string_view unit) {
  return {std::string(trimmed(name)), find_unit(unit), ""};
}

// "Pos [mm]": the last pair of brackets.
std::optional<NameAndUnit> bracketed(std::string_view header) {
  const std::size_t open = header.find_last_of(kOpening);
  if (open == std::string_view::npos || open == 0) return std::nullopt;
  const std::size_t close = header.find(kClosing[kOpening.find(header[open])], open);
  if (close == std::string_view::npos) return std::nullopt;
  const std::string_view inside = trimmed(header.substr(open + 1, close - open - 1));
  NameAndUnit result = parts(header.substr(0, open), inside);
  if (!result.unit) result.foreign_unit = std::string(inside);
  return result;
}

}  // namespace

std::string lower_ascii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::optional<Unit> find_unit(std::string_view text) {
  text = without_brackets(text);
  if (text.empty()) return std::nullopt;
  for (const Spelling& spelling : kSpellings) {
    if (spelling.text == text) return spelling.unit;
  }
  // "MN" might be meganewtons and "NM" a torque: too much to guess.
  const std::string lower = lower_ascii(text);
  if (lower == "mn" || lower == "nm" || lower == "m") return std::nullopt;
  for (const Spelling& spelling : kSpellings) {
    if (lower_ascii(spelling.text) == lower) return spelling.unit;
  }
  return std::nullopt;
}

double volts_of(std::string_view text) {
  const std::string name = lower_ascii(without_brackets(text));
  if (name == "mv" || name == "millivolt" || name == "millivolts") return 1e-3;
  return name == "v" || name == "volt" || name == "volts" ? 1.0 : 0.0;
}

NameAndUnit split_name_and_unit(std::string_view header) {
  header = trimmed(header);
  // "Position (z), mm": the unit may stand behind what the brackets say.
  auto found = bracketed(header);
  const std::size_t comma = header.rfind(',');
  if ((!found || !found->unit) && comma != std::string_view::npos && comma > 0) {
    if (NameAndUnit result = parts(header.substr(0, comma), header.substr(comma + 1)); result.unit) return result;
  }
  if (found) return *found;
  // The strongest sign first: a slash, the word "in", then a last word after any mark.
  for (const std::string_view mark : {std::string_view("/"), std::string_view(" in ")}) {
    const std::size_t at = header.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    if (NameAndUnit result = parts(header.substr(0, at), header.substr(at + mark.size())); result.unit) return result;
  }
  const std::size_t at = header.find_last_of(" _,;:-.");
  if (at != std::string_view::npos && at > 0) {
    if (NameAndUnit result = parts(header.substr(0, at), header.substr(at + 1)); result.unit) return result;
  }
  return {std::string(header), std::nullopt, ""};
}

}  // namespace palpate
