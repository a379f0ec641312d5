// Numbers as people read them. No locale: '.' everywhere.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <string>

namespace palpate {

// As printf's %.*f has it; `decimals` 0 to 100.
std::string fixed(double value, int decimals);

// As printf's %.*g has it.
std::string general(double value, int digits);

// 1234567.5 -> 1,234,567.5; `digits` as `fixed` has it.
std::string with_thousands(const std::string& digits);

// Three significant digits with thousands separated: 8.87, 0.0123, 12,300; an exponent
// from 1e7 and below 1e-4; what is not finite is a dash.
std::string three_digits(double value);

// For a label that must stay short: at most three significant digits, at most three
// decimals, no exponent: 0.412, 12.3, 1234; what is not finite is a dash.
std::string at_most_three_decimals(double value);

}  // namespace palpate
