// A lab's own file becomes a recording: any table of text in, rows in SI units out,
// and every guess that was made on the way in words.
//
//   foreign_text   bytes to text          table_layout   separator, decimal mark, header
//   units          units in headers       column_roles   time, position, force
//   table_number   one cell               import_table   all rows, units, sign, time
//
// Nothing is repaired in silence: what cannot be decided is an error that shows the
// header and the option to add.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/import/column_roles.h"
#include "engine/import/foreign_text.h"
#include "engine/import/table_layout.h"
#include "engine/import/units.h"
#include "engine/recording/recording.h"

namespace palpate {

struct ImportRequest {
  std::optional<char> decimal;  // mark; none: found out
  RoleRequest columns;
  std::vector<Unit> units;        // at most one for each quantity; they beat the header's
  std::optional<double> rate_Hz;  // evenly spaced rows; the file's time is not used
  bool flip_position = false;
  bool flip_force = false;
  std::optional<double> gain_N_per_V;  // of a force that was recorded in volts
  std::uint64_t skip_bad_rows = 0;     // so many rows may not parse
};

struct ImportedColumn {
  std::size_t number = 0;  // from 1; 0: the time of a given rate
  std::string header;
  std::string unit;  // "mm"; "clock" for a time of day or a date
  bool guessed = false;
};

struct ImportedTable {
  Recording recording;
  TextEncoding encoding = TextEncoding::utf8;
  TableLayout layout;  // its names and units are gone with the text
  std::array<ImportedColumn, kRoles> columns;
  std::vector<std::string> notes;  // sentences: guesses, what was left out, advice
};

// Reads `path`. Errors: "path: ..." or "path:line: ...".
Result<ImportedTable> import_table(const std::string& path, const ImportRequest& request);
// The same from memory; `label` stands in messages.
Result<ImportedTable> import_table(const ForeignText& text, const std::string& label, const ImportRequest& request);

}  // namespace palpate
