// Descriptions of an import and its guesses: for the terminal, the window and the comments of the recording.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "engine/import/import_table.h"

namespace palpate {

// "comma" or "point".
std::string decimal_name(const TableLayout& layout);
// The source of a role's values: column 2 "Weg [mm]" in mm (guessed).
std::string column_words(const ImportedColumn& column);
// The format of the table: "semicolon between fields, decimal comma, ...".
std::string table_words(const ImportedTable& table);
// The roles whose sign was changed.
std::vector<std::string> flipped_roles(const ImportRequest& request);
// The comments of the recording on its origin, without path and date.
std::vector<std::string> import_origin(const std::string& file, const ImportRequest& request,
                                       const ImportedTable& table);

// "1.5", to six digits; "3 rows".
std::string short_number(double value);
std::string count_of(std::uint64_t count, const char* what);
// Error messages for one row, with advice. `quoted_name`: the column's name after a blank, or empty.
// A time that is not later than that of the row before; `rows`: number of rows so far.
std::string time_fault_words(const std::string& quoted_name, double time_s, double last_time_s, std::size_t rows);
// A position (role 1) or a force (role 2) beyond the limits of recordings.
std::string size_fault_words(const RecordingRow& row, const ImportedColumn& column, std::size_t role,
                             const std::string& quoted_name);

}  // namespace palpate
