// Where the table in a foreign text begins and how its rows are written: what
// separates the fields, which decimal mark, which line names the columns, which
// line has their units, where the numbers start.
//
// Every pair of separator and decimal mark is tried on the first lines; the pair
// under which most cells are numbers and none is a mangled one wins. The longest
// run of rows of numbers is the table, the nearest line above it that names as many
// columns is the header; whatever stands further above is a preamble.
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

// `said`: the decimal mark, where the user has said which. Errors (without the file's name):
// no rows of numbers; a comma that may be a decimal mark or a thousands mark.
Result<TableLayout> find_table_layout(std::string_view text, std::optional<char> said);

// The fields of one line, without blanks and quotes around them. `fields` is filled
// anew; empty fields at the end of the line are left out.
void split_table_fields(std::string_view line, Delimiter delimiter, std::vector<std::string_view>& fields);

// The line at the start of `text` (which loses it) without its line end.
std::string_view next_line(std::string_view& text);

}  // namespace palpate
