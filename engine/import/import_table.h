// Converts a text table of another program into a recording in SI units. Nothing is repaired without a note: what
// cannot be determined is an error that shows the header and the option to add.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/import/column_roles.h"
#include "engine/import/table_layout.h"
#include "engine/import/units.h"
#include "engine/recording/recording.h"

namespace palpate {

struct ImportRequest {
  std::optional<char> decimal;  // decimal mark; none: to be determined
  RoleRequest columns;
  std::vector<Unit> units;        // at most one for each quantity; they take precedence over the header
  std::optional<double> rate_Hz;  // for evenly spaced rows, instead of the file's time
  bool flip_position = false, flip_force = false;
  std::optional<double> gain_N_per_V;  // for a force recorded in volts
  std::uint64_t skip_bad_rows = 0;     // number of rows that may be unreadable
};

struct ImportedTable {
  Recording recording;
  std::string_view encoding;
  TableLayout layout;  // without names and units, which refer to the text
  RoleColumns columns;
  std::vector<std::string> notes;  // sentences: guesses, omissions, advice
};

// Reads `path`. Errors: "path: ..." or "path:line: ...".
Result<ImportedTable> import_table(const std::string& path, const ImportRequest& request);
// The functions below describe the result for the terminal, the window and the comments of the recording.
// The source of a role's values, e.g. column 2 "Weg [mm]" in mm (guessed).
std::string column_words(const ImportedColumn& column);
// The roles whose sign was changed.
std::vector<std::string> flipped_roles(const ImportRequest& request);
// The comments of the recording on its origin, without path and date.
std::vector<std::string> import_origin(const std::string& file, const ImportRequest& request,
                                       const ImportedTable& table);

}  // namespace palpate
