// The units in headers of tables, and the ways in which they are written: "Pos [mm]", "Fz (mN)", "t/ms", "Force_N",
// "Standardkraft in N", "Weg mm".
// Thread guarantee: pure functions, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate {

enum class Quantity { time, length, force };

struct Unit {
  std::string_view name;  // printed name: "mm"
  Quantity quantity = Quantity::time;
  double to_si = 1.0;  // size of the unit in s, m or N
};

// Whether `list`, words separated by blanks, contains this word.
bool is_word_of(std::string_view list, std::string_view word);
// The unit with the name `text`: with exact case ("mN" is not "MN"), else in any case if it is unambiguous ("MM",
// "Sec"). A gram is the force of its weight.
std::optional<Unit> find_unit(std::string_view text);

struct NameAndUnit {
  std::string name;          // without the unit
  std::optional<Unit> unit;  // when it is known
  std::string foreign_unit;  // unknown unit: "%", "degC", "hN"
};

// The names of the units of a quantity: "m, cm, mm, um, nm, inch, mil, ft".
std::string unit_names(Quantity quantity);
// Whether `text` is a unit of another quantity or a word for a number without a unit: "%", "MPa", "mm/s", "cycles".
bool is_other_unit(std::string_view text);
// The size in volts of the unit in `text`, "V" or "mV" in any common spelling; 0: no voltage.
double volts_of(std::string_view text);
// Separates the name and the unit of a column.
NameAndUnit split_name_and_unit(std::string_view header);

}  // namespace palpate
