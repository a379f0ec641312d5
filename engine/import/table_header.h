// Finds the lines of names and of units shortly above a table. Preferred: a line that names at least two of time,
// position and force (boards print their status below the header); among these one split by the separator of the table,
// and then the one with more names and units; then the nearest. In a line of units most fields are units. Thread
// guarantee: slow side only.
#pragma once

#include <string_view>
#include <vector>

#include "engine/import/table_layout.h"

namespace palpate {

// Sets names, units and their lines in `layout`, which describes the rows from lines[first]. `widest`: the fields of
// the widest rows; a header with as many names determines the number of columns.
void find_table_header(const std::vector<std::string_view>& lines, std::size_t first, std::size_t widest,
                       TableLayout& layout);

}  // namespace palpate
