#include <array>
#include <vector>

#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

constexpr double kGramForce_N = 9.80665e-3;  // standard gravity
constexpr double kPoundForce_N = 4.4482216152605;

struct SpelledUnit {
  Unit unit;
  std::string_view spellings;  // between blanks
};

// The micro sign is U+00B5 or, in some fonts' files, the Greek U+03BC.
constexpr std::array kUnits = {
    SpelledUnit{{"s", Quantity::time, 1.0}, "s sec secs second seconds Sek Sekunden secondes"},
    SpelledUnit{{"ms", Quantity::time, 1e-3}, "ms msec msecs millis millisecond milliseconds"},
    SpelledUnit{{"us", Quantity::time, 1e-6}, "us \xC2\xB5s \xCE\xBCs usec usecs micros microsecond microseconds"},
    SpelledUnit{{"ns", Quantity::time, 1e-9}, "ns nsec nsecs nanos nanosec nanosecond nanoseconds"},
    SpelledUnit{{"ticks", Quantity::time, 1e-7}, "ticks"},
    SpelledUnit{{"min", Quantity::time, 60.0}, "min minute minutes"},
    SpelledUnit{{"h", Quantity::time, 3600.0}, "h hr hrs hour hours"},
    SpelledUnit{{"days", Quantity::time, 86400.0}, "day days"},
    SpelledUnit{{"m", Quantity::length, 1.0}, "m meter meters metre metres"},
    SpelledUnit{{"cm", Quantity::length, 1e-2}, "cm"},
    SpelledUnit{{"mm", Quantity::length, 1e-3}, "mm millimeter millimeters"},
    SpelledUnit{{"um", Quantity::length, 1e-6}, "um \xC2\xB5m \xCE\xBCm micron microns"},
    SpelledUnit{{"nm", Quantity::length, 1e-9}, "nm"},
    SpelledUnit{{"inch", Quantity::length, 25.4e-3}, "in inch inches"},
    SpelledUnit{{"mil", Quantity::length, 25.4e-6}, "mil mils thou"},
    SpelledUnit{{"ft", Quantity::length, 304.8e-3}, "ft foot feet"},
    SpelledUnit{{"N", Quantity::force, 1.0}, "N newton newtons"},
    SpelledUnit{{"mN", Quantity::force, 1e-3}, "mN"},
    SpelledUnit{{"uN", Quantity::force, 1e-6}, "uN \xC2\xB5N \xCE\xBCN"},
    SpelledUnit{{"nN", Quantity::force, 1e-9}, "nN"},
    SpelledUnit{{"pN", Quantity::force, 1e-12}, "pN"},
    SpelledUnit{{"cN", Quantity::force, 1e-2}, "cN"},
    SpelledUnit{{"dN", Quantity::force, 1e-1}, "dN"},
    SpelledUnit{{"daN", Quantity::force, 1e1}, "daN"},
    SpelledUnit{{"kN", Quantity::force, 1e3}, "kN"},
    SpelledUnit{{"g", Quantity::force, kGramForce_N}, "g gf gram grams"},
    SpelledUnit{{"kg", Quantity::force, 1e3 * kGramForce_N}, "kg kgf kp kilopond"},
    SpelledUnit{{"ozf", Quantity::force, kPoundForce_N / 16.0}, "ozf oz"},
    SpelledUnit{{"lbf", Quantity::force, kPoundForce_N}, "lbf lb lbs"},
    SpelledUnit{{"kip", Quantity::force, 1e3 * kPoundForce_N}, "kip kips klbf"},
};

// In lower case.
constexpr std::string_view kOtherUnits =
    "% a amp ma v mv volt volts pa kpa mpa gpa psi bar mbar c degc \xC2\xB0"
    "c degf \xC2\xB0"
    "f k deg degrees \xC2\xB0 "
    "rad rev rpm hz khz nm n*m n\xC2\xB7m ncm j mj w count counts cnt cycle cycles segment segments step steps pulse "
    "pulses point points pts lsb bit bits digit digits raw adc pwm none unitless";

constexpr std::string_view kOpening = "[(<{";
constexpr std::string_view kClosing = "])>}";

std::string_view without_brackets(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2) return text;
  const std::size_t kind = kOpening.find(text.front());
  if (kind == std::string_view::npos || text.back() != kClosing[kind]) return text;
  return trimmed(text.substr(1, text.size() - 2));
}

}  // namespace

// Whether `text` is a unit with a prefix that is in no list: "hN".
bool is_prefixed_unit(std::string_view text) {
  for (const std::string_view prefix : {"da", "h", "k", "M", "G", "T", "d", "c", "m", "u", "n", "p", "f"})
    if (text.starts_with(prefix) && is_word_of("N m s g lbf", text.substr(prefix.size()))) return true;
  return false;
}

bool is_word_of(std::string_view list, std::string_view word) {
  if (word.empty() || word.find(' ') != std::string_view::npos) return false;
  for (std::size_t at = 0; (at = list.find(word, at)) != std::string_view::npos; ++at) {
    const std::size_t end = at + word.size();
    if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' ')) return true;
  }
  return false;
}

std::optional<Unit> find_unit(std::string_view text) {
  text = without_brackets(text);
  if (text.empty()) return std::nullopt;
  for (const SpelledUnit& one : kUnits)
    if (is_word_of(one.spellings, text)) return one.unit;
  // "MN" may be meganewtons, "NM" a torque, "PN" a number of a part and "DN" a diameter, so they are not guessed.
  const std::string lower = lower_ascii(text);
  if (is_word_of("mn nm m pn nn dn", lower)) return std::nullopt;
  for (const SpelledUnit& one : kUnits)
    if (is_word_of(lower_ascii(one.spellings), lower)) return one.unit;
  return std::nullopt;
}

std::string unit_names(Quantity quantity) {
  std::vector<std::string> names;
  for (const SpelledUnit& one : kUnits)
    if (one.unit.quantity == quantity) names.emplace_back(one.unit.name);
  return joined(names);
}

bool is_other_unit(std::string_view text) {
  text = without_brackets(text);
  const std::size_t slash = text.find('/');
  // A rate, a stiffness: "mm/s", "N/mm", "1/s".
  if (slash != std::string_view::npos && find_unit(text.substr(slash + 1))) return true;
  return is_word_of(kOtherUnits, lower_ascii(text));
}

double volts_of(std::string_view text) {
  const std::string name = lower_ascii(without_brackets(text));
  if (is_word_of("mv millivolt millivolts", name)) return 1e-3;
  return is_word_of("v volt volts", name) ? 1.0 : 0.0;
}

}  // namespace palpate
