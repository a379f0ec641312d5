// Text of files and messages: blanks, letters, UTF-8, and numbers with '.' as decimal point in every locale.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate {

// `text` without blanks (space, tab) at both ends.
std::string_view trimmed(std::string_view text);

// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view between = ", ");

// `text` with `to` for every `from`.
std::string replaced(std::string_view text, std::string_view from, std::string_view to);

// `text` with A to Z replaced by a to z.
std::string lower_ascii(std::string_view text);

// The number of bytes at the start of `text` that are well-formed UTF-8. Source: RFC 3629, section 4.
std::size_t utf8_bytes(std::string_view text);

// `text` with bytes that are not printable as \xHH, truncated ("...") after about `limit`; npos: whole, with its lines.
std::string printable(std::string_view text, std::size_t limit = 40);

// "path:line:column: ", the beginning of a message about the byte at `offset` of `text`; columns count bytes from 1.
std::string position_prefix(const std::string& path, std::string_view text, std::size_t offset);

// The one of `names` that is nearest to `word`, by the number of letters to insert, delete or replace (Levenshtein
// 1966); empty if every one needs more than a third of the letters of `word`, and more than 2.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

// `text` as one word of a shell, in quotes where it needs them.
std::string shell_word(const std::string& text);

// Parses one decimal number at `begin`, correctly rounded; a leading '+' is accepted. Returns its end, or nullptr if
// there is no finite number.
const char* parse_number(const char* begin, const char* end, double& value);

// The shortest decimal form that reads back as the same double.
std::string shortest(double value);

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
