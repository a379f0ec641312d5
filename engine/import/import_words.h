// What an import has found and guessed, in words: for a terminal, a window and the
// comments of the recording that it becomes.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "engine/import/import_table.h"

namespace palpate {

// "comma" or "point".
std::string decimal_name(const TableLayout& layout);
// Where a role's values come from: column 2 "Weg [mm]" in mm (guessed).
std::string column_words(const ImportedColumn& column);
// How the table is written: "semicolon between fields, decimal comma, ...".
std::string table_words(const ImportedTable& table);
// The roles whose sign was turned round.
std::vector<std::string> flipped_roles(const ImportRequest& request);
// What the recording says of its origin, with no path and no date.
std::vector<std::string> import_origin(const std::string& file, const ImportRequest& request,
                                       const ImportedTable& table);

}  // namespace palpate
