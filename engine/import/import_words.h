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

// "1.5", to six digits; "3 rows".
std::string short_number(double value);
std::string count_of(std::uint64_t count, const char* what);
// What is wrong with a row, and what to do. `quoted_name`: of its column, with a blank before,
// or empty. A time that is not later than the last, in a table of so many rows:
std::string time_fault_words(const std::string& quoted_name, double time_s, double last_time_s, std::size_t rows);
// A position (role 1) or a force (2) that no recording has.
std::string size_fault_words(const RecordingRow& row, const ImportedColumn& column, std::size_t role,
                             const std::string& quoted_name);

}  // namespace palpate
