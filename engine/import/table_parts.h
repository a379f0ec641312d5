// The parts of a foreign table, inside this room: text, cells, units, layout, and the roles of columns.
// Thread guarantee: slow side only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/import/import_table.h"

namespace palpate {

// Text (table_text.cpp).
struct ForeignText {
  std::string text;  // UTF-8 without byte order mark; minus signs and blanks of Unicode are those of ASCII
  std::string_view encoding = "UTF-8";  // of the file: UTF-8, Latin-1 or UTF-16
};
// Errors, each with advice: no such file, not a regular file, unreadable, too large, empty, an archive, binary.
Result<ForeignText> read_foreign_text(const std::string& path);
// The lines without their ends: LF, CRLF, or CR alone.
std::vector<std::string_view> lines_of(std::string_view text);

struct Delimiter {
  std::string_view name;
  std::string_view marks;  // characters that separate two fields

  bool is_blanks() const noexcept { return marks.size() > 1; }
};
// In the order in which they are tried.
inline constexpr std::array kDelimiters = {Delimiter{"tab", "\t"}, Delimiter{"semicolon", ";"}, Delimiter{"bar", "|"},
                                           Delimiter{"comma", ","}, Delimiter{"blanks", " \t"}};
using Fields = std::vector<std::string_view>;
using Lines = std::span<const std::string_view>;
// The fields of one line without blanks and quotes around them. `fields` is replaced; empty fields at the end of the
// line are omitted. Returns the number of fields with these.
std::size_t split_table_fields(std::string_view line, const Delimiter& delimiter, Fields& fields);

// Cells (table_cell.cpp).
// Whether `text` is a number, which is then in `value`: "0.5", "-1,25e-3", "+3", "1.5D+00"; also with unambiguous
// thousands marks: the other mark, an apostrophe or a blank, in groups of three, followed by the decimal mark or
// repeated ("1,234.5", "1.234.567"). NaN and infinity are not numbers.
bool parse_table_number(std::string_view text, char decimal, double& value);
// A number, or a number with a unit ("1.5 mm").
struct TableCell {
  double value = 0.0;
  std::optional<Unit> unit{};
};
std::optional<TableCell> parse_table_cell(std::string_view text, char decimal);
// "nan", "-", "---", "n/a", "OL": a cell for a missing value.
bool is_missing_value(std::string_view text);
// Whether `field` is a date, a time of day or a duration: "2024-03-05T14:03:22.123Z", "3/5/2024 2:03:22.5 PM",
// "05-Mar-2024 14:03:22", "14:03:22.123", "03:22.123", "0 days 00:00:01.5".
bool is_of_a_clock(std::string_view field);

// The times of the rows in the unit of the file (of a clock: s), since the first one; NaN where a cell is no time.
struct ColumnTimes {
  std::vector<double> since_first{};
  bool of_a_clock = false, with_dates = false;
  bool whole = true;         // no cell has a fraction
  double first_cell = 0.0;   // the first time itself
  double plain_step = 0.0;   // median of the steps
  double median_step = 0.0;  // also over rows without a step
  bool steady = false;       // the mean step is the median
  int midnights = 0;         // a clock without dates that goes back by more than half a day has passed midnight

  void measure_steps();
};
// Decides from all cells of the column whether they are those of a clock, and the order of day and month. Errors: a
// cell that is no time, and what to write instead.
Result<ColumnTimes> read_times(const Fields& cells, char decimal);

// Units (units.cpp).
// Whether `list`, words separated by blanks, contains this word.
bool is_word_of(std::string_view list, std::string_view word);
// Whether `text` is a unit of another quantity or a word for a number without a unit: "%", "MPa", "mm/s", "cycles".
bool is_other_unit(std::string_view text);
// Whether `text` is a unit with a prefix that is in no list: "hN".
bool is_prefixed_unit(std::string_view text);
// The size in volts of the unit in `text`, "V" or "mV" in any common spelling; 0: no voltage.
double volts_of(std::string_view text);

// Blocks of rows, and their header (table_layout.cpp).
// A run of rows of numbers.
struct RowBlock {
  std::size_t begin = 0, end = 0;  // lines
  std::size_t rows = 0, fields = 0;
};
struct TableLayout {
  Delimiter delimiter{};
  char decimal = '.';
  std::size_t fields = 0;      // of a row, empty ones included
  std::size_t columns = 0;     // of a row; empty cells at its end do not count
  std::size_t widest = 0;      // fields of the widest rows that are no exception
  bool first_is_word = false;  // of most rows
  std::vector<RowBlock> blocks{};
  bool skippable = true;  // the lines between the blocks are no headers, so that they may be left out

  Fields names{};          // one a column, unless `misfit`; empty without a header
  bool misfit = false;     // the number of names is not that of the columns
  Fields units{};          // one a column; empty without a row of units
  std::size_t header = 0;  // line, from 1; 0 without a header
  std::size_t rival = 0;   // another line that names the columns, from 1
  // From a file of LabVIEW without times: the interval and the first time of each column.
  std::vector<double> steps_s{}, starts_s{};
};
// Tries every pair of separator and decimal mark, then puts every line into a block of rows. A line of text between
// rows ends a block, unless `most_bad` more lines may be left out. Errors (without the file's name): no rows of
// numbers; a comma or point that may be either mark, unless the decimal mark is given.
Result<TableLayout> find_table_layout(Lines lines, std::optional<char> given_decimal, std::uint64_t most_bad);
// Whether a line is a row of the table, perhaps damaged, by its numbers.
bool is_row(const TableLayout& layout, std::string_view line, Fields& fields);
// Sets the lines of names and of units shortly above the row `first`. Preferred is a line that names at least two of
// time, position and force (boards print their status below the header).
void find_table_header(Lines lines, std::size_t first, TableLayout& layout);

// Columns (column_roles.cpp).
struct NameAndUnit {
  std::string name{};           // without the unit
  std::optional<Unit> unit{};   // when it is known
  std::string foreign_unit{};   // unknown unit: "%", "degC", "hN"
  std::string contradicting{};  // a second unit, of the name or of the row of units
};
// Separates the name and the unit of a column: "Pos [mm]", "Fz (mN)", "t/ms", "Force_N", "Standardkraft in N". What
// follows a mark after a word for a role ("Kraft/Stein", "Weg in Furlong") is an unknown unit.
NameAndUnit header_parts(std::string_view header);

struct ForeignColumn {
  std::string header{};  // as in the file; without a header its first value
  NameAndUnit parts{};
  bool constant = true;               // in all rows
  bool is_units = true;               // every cell is a unit: that of the column before
  bool is_clock = true;               // every cell is of a clock
  bool is_whole = true;               // every cell is a whole number
  std::vector<std::string> values{};  // the first different ones, at most kMostValues
  std::size_t changes = 0;            // rows with another value than the row above
};
inline constexpr std::size_t kMostValues = 40;

// The roles that the fields of a line name, by words or units.
struct NamedRoles {
  int count = 0;
  std::array<std::size_t, kRoles> column{};  // from 1; 0: none, or several with equal claims
};
NamedRoles named_roles(const Fields& fields);

// An option that makes a table readable, and what it means.
struct Reading {
  std::string option, meaning;
};
struct RoleChoice {
  std::array<std::size_t, kRoles> number{};  // of the column of each role, from 1; 0 without a time
  std::array<bool, kRoles> unnamed{};        // chosen although its name does not say so
  std::vector<std::size_t> times{};          // all columns that claim to be the time, from 1
  std::string problem{};                     // otherwise
  std::vector<Reading> readings{};
};
// Chooses a column for each role. `needs_time`: false with a given rate. Problems: an unknown name; no column or
// several for a role; one for two roles; a unit that contradicts the name ("Position (N)").
RoleChoice choose_columns(const std::vector<ForeignColumn>& columns, const RoleRequest& request, bool has_header,
                          bool needs_time);
// The part of a second that a column counts, from its name: "nanosec" 1e-9; 0: none.
double fraction_unit_s(const ForeignColumn& column);
// Whether a column says what a row belongs to ("specimen", "sensor_id").
bool identifies(const ForeignColumn& column);
// The columns for a message: 1 "Zeit [s]", 2 "Weg [mm]".
std::string list_columns(const std::vector<ForeignColumn>& columns);

}  // namespace palpate
