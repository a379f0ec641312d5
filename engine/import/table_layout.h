// Determines the layout of the table in a foreign text: separator of fields, decimal mark, the lines of column names
// and of units, and the first line of numbers.
//
// Every pair of separator and decimal mark is tried on the first lines. Pairs are preferred in which no field begins
// like a number without being one, and among these the pair with the most numbers. The longest run of rows of numbers
// is the table, and the nearest line above it with names for all columns is the header; lines further above are a
// preamble.
// Thread guarantee: slow side only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

enum class Delimiter { comma, semicolon, tab, blanks };
std::string_view delimiter_name(Delimiter delimiter);

struct TableLayout {
  Delimiter delimiter = Delimiter::comma;
  char decimal = '.';
  std::size_t columns = 0;              // of a row of numbers
  std::vector<std::string_view> names;  // one a column; empty without a header
  std::vector<std::string_view> units;  // one a column; empty without a row of units
  std::uint64_t header_line = 0;        // from 1; 0 without a header
  std::uint64_t data_line = 0;
  std::size_t data_offset = 0;  // in the text
};

// `given_decimal`: the decimal mark if the user has given it. Errors (without the file's name): no rows of numbers; a
// comma that may be a decimal mark or a thousands mark.
Result<TableLayout> find_table_layout(std::string_view text, std::optional<char> given_decimal);

// The fields of one line without blanks and quotes around them. `fields` is replaced; empty fields at the end of the
// line are omitted.
void split_table_fields(std::string_view line, Delimiter delimiter, std::vector<std::string_view>& fields);

// Removes the first line from `text` and returns it without its line end.
std::string_view next_line(std::string_view& text);

}  // namespace palpate
