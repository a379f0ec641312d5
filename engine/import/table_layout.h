// Reads a file of another program as text, and determines the layout of its table. Every pair of separator and decimal
// mark is tried on the first lines: preferred are those in which no field begins like a number without being one, then
// the one with the most numbers. The longest run of rows of numbers is the table; its header is above it
// (table_header.cpp). Thread guarantee: slow side only (does I/O).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

struct Delimiter {
  std::string_view name;
  std::string_view marks;  // characters that separate two fields

  bool is_blanks() const noexcept { return marks.size() > 1; }
};

// In the order in which they are tried.
inline constexpr std::array kDelimiters = {Delimiter{"tab", "\t"}, Delimiter{"semicolon", ";"}, Delimiter{"comma", ","},
                                           Delimiter{"blanks", " \t"}};

struct TableLayout {
  Delimiter delimiter;
  char decimal = '.';
  std::size_t columns = 0;              // of a row of numbers; empty cells at its end do not count
  std::vector<std::string_view> names;  // one a column, unless `misfit`; empty without a header
  bool misfit = false;                  // the number of names is not that of the columns
  std::uint64_t rival_line = 0;         // a line that names other columns for position and force than the header
  std::vector<std::string_view> units;  // one a column; empty without a row of units
  std::uint64_t header_line = 0;        // from 1; 0 without a header
  std::uint64_t data_line = 0;
  std::size_t data_offset = 0;  // in the text
  double step_s = 0.0;          // interval of the rows, as text files of LabVIEW have it above a table without times

  const char* decimal_name() const noexcept { return decimal == ',' ? "comma" : "point"; }
  // "semicolon between fields, decimal comma, UTF-8, ..."
  std::string words(std::string_view encoding) const;
};

// `given_decimal`: the decimal mark if the user has given it. Errors (without the file's name): no rows of numbers; a
// comma that may be a decimal mark or a thousands mark.
Result<TableLayout> find_table_layout(std::string_view text, std::optional<char> given_decimal);
// Finds the lines of names and of units shortly above a table and sets them in `layout`, which describes the rows from
// lines[first]. Preferred: a line that names at least two of time, position and force (boards print their status below
// the header); among these one split by the separator of the table, and then the one with more names and units; then
// the nearest. In a line of units most fields are units. `widest`: the fields of the widest rows; a header with as many
// names determines the number of columns.
void find_table_header(const std::vector<std::string_view>& lines, std::size_t first, std::size_t widest,
                       TableLayout& layout);
// The fields of one line without blanks and quotes around them. `fields` is replaced; empty fields at the end of the
// line are omitted. Returns the number of fields with these.
std::size_t split_table_fields(std::string_view line, const Delimiter& delimiter,
                               std::vector<std::string_view>& fields);
// Removes the first line from `text` and returns it without its line end.
std::string_view next_line(std::string_view& text);

struct ForeignText {
  std::string text;                     // UTF-8 without byte order mark
  std::string_view encoding = "UTF-8";  // of the file: UTF-8, Latin-1 or UTF-16
};

// Errors: no such file, not a regular file, unreadable, too large, empty, an Excel workbook or another binary file;
// each with advice.
Result<ForeignText> read_foreign_text(const std::string& path);

}  // namespace palpate
