// Numbers as text for people, with '.' as decimal point in every locale.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <string>

namespace palpate {

// As printf's %.*f; `decimals` 0 to 100.
std::string fixed(double value, int decimals);

// As printf's %.*g.
std::string general(double value, int digits);

// 1234567.5 -> 1,234,567.5; `digits`: the result of `fixed`.
std::string with_thousands(const std::string& digits);

// Three significant digits with thousands separators: 8.87, 0.0123, 12,300; an exponent from 1e7 on and below 1e-4; a
// dash for NaN and infinity.
std::string three_digits(double value);

// For short labels: at most three significant digits, at most three decimals, no exponent: 0.412, 12.3, 1234; a dash
// for NaN and infinity.
std::string at_most_three_decimals(double value);

}  // namespace palpate
