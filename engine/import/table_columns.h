// Determines what the columns of a foreign table mean: the roles with their units, and the times.
// Thread guarantee: slow side only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/import/column_roles.h"
#include "engine/import/import_table.h"
#include "engine/import/table_cell.h"

namespace palpate {

// The messages about one file: errors with its name, and notes, sentences on guesses, omissions and advice.
struct ImportMessages {
  std::string label;
  std::vector<std::string> notes{};

  Error fail(const std::string& text) const { return Error{label + ": " + text}; }
  Error fail_at(std::uint64_t line, const std::string& text) const {
    return Error{label + ":" + std::to_string(line) + ": " + text};
  }
  void note(const std::string& sentence) { notes.push_back(sentence); }
};

struct TableColumns {
  std::vector<ForeignColumn> header;
  RoleColumns roles;
  std::array<double, kRoles> to_si{1.0, 1.0, 1.0};
  RowTimes times{'.'};
  bool own_time = false;  // the file has times; with a given rate they are only compared with it
  std::optional<VelocityColumn> velocity;

  // The index of the column of a role; beyond every row if there is none.
  std::size_t index_of(std::size_t role) const { return roles[role].number - 1; }
  // ' "Weg [mm]"' for a message; empty without a header.
  std::string quoted_name(std::size_t index) const;
};

// `layout`: loses a header that does not fit if the user gives the numbers of the columns. Errors: those of
// choose_columns; a header with too few names; two headers that contradict each other; a unit that is missing, unknown
// or of another quantity.
Result<TableColumns> find_table_columns(std::string_view text, const ImportRequest& request, TableLayout& layout,
                                        ImportMessages& messages);

}  // namespace palpate
