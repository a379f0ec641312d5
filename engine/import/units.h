// Units that rigs write into the headers of their tables, and where they write
// them: "Pos [mm]", "Fz (mN)", "t/ms", "Force_N", "Standardkraft in N", "Weg mm".
// Thread guarantee: pure functions, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate {

enum class Quantity { time, length, force };

struct Unit {
  std::string_view name;  // as it is printed: "mm"
  Quantity quantity = Quantity::time;
  double to_si = 1.0;  // s, m or N for one of it
};

// Whether `list`, words between blanks, has this one.
bool is_word_of(std::string_view list, std::string_view word);

// The unit called `text`: exact case first ("mN" is not "MN"), then any case where
// only one thing can be meant ("MM", "Sec"). Grams count as the force of their weight.
std::optional<Unit> find_unit(std::string_view text);

struct NameAndUnit {
  std::string name;          // without the unit
  std::optional<Unit> unit;  // when it is known
  std::string foreign_unit;  // in brackets but unknown: "%", "degC"
};

// Volts in one of what `text` names, "V" or "mV" in any common spelling; 0: no voltage.
double volts_of(std::string_view text);

// Takes a column's name and its unit apart.
NameAndUnit split_name_and_unit(std::string_view header);

}  // namespace palpate
