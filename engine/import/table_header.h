// Finds the lines of names and of units above a table.
//
// The header is a line shortly above the table with a name for each column. A line that names at least two of time,
// position and force is preferred to any other: boards print their status below the header. Among these, a line split
// by the separator of the table is preferred to one split by another, and then the one with more names and units. Lines
// without such names follow, the nearest first. In a line of units most fields are units.
// Thread guarantee: slow side only.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "engine/import/table_layout.h"

namespace palpate {

// Sets names, units and their lines in `layout`, which describes the rows from lines[first]. `widest`: the fields of
// the widest rows; a header with as many names determines the number of columns.
void find_table_header(const std::vector<std::string_view>& lines, std::size_t first, std::size_t widest,
                       TableLayout& layout);

}  // namespace palpate
