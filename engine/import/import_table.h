// Converts a text table of another program into a recording in SI units. A table is imported when one reading of it
// explains every row. Otherwise the error lists the readings that remain, each as a command.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

enum class Quantity { time, length, force };

struct Unit {
  std::string_view name;  // printed name: "mm"
  Quantity quantity = Quantity::time;
  double to_si = 1.0;  // size of the unit in s, m or N
};

// The unit with the name `text`: with exact case ("mN" is not "MN"), else in any case if it is unambiguous ("MM",
// "Sec"). A gram is the force of its weight.
std::optional<Unit> find_unit(std::string_view text);
// The names of the units of a quantity: "m, cm, mm, um, nm, inch, mil, ft".
std::string unit_names(Quantity quantity);

// The order is that of Quantity.
inline constexpr std::size_t kRoles = 3;
inline constexpr std::array<const char*, kRoles> kRoleNames = {"time", "position", "force"};
// The user's choice for each role: a name or a number from 1; empty: to be determined.
using RoleRequest = std::array<std::string, kRoles>;

// Lines of a file, from 1, both included.
struct LineRange {
  std::uint64_t first = 0, last = 0;
};

struct ImportRequest {
  std::string command;            // as the user gave it; the readings that remain add their options to it
  std::optional<char> decimal{};  // decimal mark; none: to be determined
  RoleRequest columns{};
  std::vector<Unit> units{};        // at most one for each quantity; they take precedence over the header
  std::optional<double> rate_Hz{};  // for evenly spaced rows, instead of the file's time
  bool flip_position = false, flip_force = false;
  std::optional<double> gain_N_per_V{};  // for a force recorded in volts
  std::uint64_t skip_bad_rows = 0;       // number of rows that may be unreadable
  std::optional<LineRange> rows{};       // only these lines, whatever the block
  std::size_t block = 0;                 // from 1: only this block of rows; 0: all rows must be one
};

// The column of a role.
struct ImportedColumn {
  std::size_t number = 0;        // from 1; 0: the time of a given rate
  std::string header{}, unit{};  // "mm"; "clock" for a time of day or a date, "each row's" for units in the rows
  bool guessed = false;          // the unit is not in the file, but inferred
};
using RoleColumns = std::array<ImportedColumn, kRoles>;

// Lines that are not rows of the recording.
struct LeftOut {
  std::string reason;
  std::uint64_t rows = 0;
  LineRange lines{};
};

struct ImportedTable {
  Recording recording;  // its position and force are not yet limited
  std::string_view encoding, delimiter, decimal;
  std::uint64_t header_line = 0;  // from 1; 0 without a header
  LineRange lines;                // from the first row that was read to the last
  RoleColumns columns;
  std::vector<LeftOut> left_out;
  std::vector<std::string> notes{};  // sentences: inferences, corrections, advice
};

// Reads `path`. Errors: "path: ..." or "path:line: ...", followed by a line for each reading that remains.
Result<ImportedTable> import_table(const std::string& path, const ImportRequest& request);
// Refuses positions and forces beyond the limits of a recording, to be called after all corrections.
Status check_limits(const std::string& path, const ImportRequest& request, const ImportedTable& table);

// The functions below describe the result for the terminal, the window and the comments of the recording.
// "semicolon between fields, decimal comma, UTF-8, ..."
std::string layout_words(const ImportedTable& table);
// "1200 read, lines 2 to 1201", and a line for each reason to leave rows out.
std::vector<std::string> row_words(const ImportedTable& table);
// The source of a role's values, e.g. column 2 "Weg [mm]" in mm.
std::string column_words(const ImportedColumn& column);
// The roles whose sign was changed.
std::vector<std::string> flipped_roles(const ImportRequest& request);
// The comments of the recording on its origin, without path and date.
std::vector<std::string> import_origin(const std::string& file, const ImportRequest& request,
                                       const ImportedTable& table);

}  // namespace palpate
