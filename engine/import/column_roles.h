// Determines which columns of a foreign table are the time, the position and the force, from their names (English,
// German, French, and those of common programs) and units. If two columns fit equally well, the user has to decide.
// Thread guarantee: slow side only.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/import/table_layout.h"
#include "engine/import/units.h"

namespace palpate {

inline constexpr std::size_t kRoles = 3;
inline constexpr std::array<const char*, kRoles> kRoleNames = {"time", "position", "force"};

// A column with its header; without a header the name is its first value.
struct ForeignColumn {
  std::string header;  // as in the file
  NameAndUnit parts;
  bool constant = false;  // in the first rows, so that it cannot be the time
};

// The columns of the table. `rows`: the fields of its first rows.
std::vector<ForeignColumn> foreign_columns(const TableLayout& layout,
                                           const std::vector<std::vector<std::string_view>>& rows);

// How well a line names the columns of a table: the roles that its fields name, by words or units, and the sum of the
// strongest claims.
struct NamedRoles {
  int count = 0, strength = 0;
  std::array<std::size_t, kRoles> column{};  // from 1; 0: none, or several with equal claims

  // Whether both name other columns for the position and for the force.
  bool contradicts(const NamedRoles& other) const;
};
NamedRoles named_roles(const std::vector<std::string_view>& fields);

// The user's choice for each role: a name or a number from 1; empty: to be determined.
using RoleRequest = std::array<std::string, kRoles>;

// The column of a role.
struct ImportedColumn {
  std::size_t number = 0;  // from 1; 0: the time of a given rate
  std::string header;
  std::string unit;  // "mm"; "clock" for a time of day or a date
  bool guessed = false;
};
using RoleColumns = std::array<ImportedColumn, kRoles>;

// Chooses a column for each role; units stay empty. `needs_time`: false with a given rate. Errors (without the file's
// name), with the header and the option to add: an unknown name; no column or several for a role; one for two roles; a
// guess by the unit that contradicts the name ("Position (N)").
Result<RoleColumns> choose_columns(const std::vector<ForeignColumn>& columns, const RoleRequest& request,
                                   bool has_header, bool needs_time);

// The only column that is a measured velocity by name and unit ("Speed (mm/s)"); none if there are several.
struct VelocityColumn {
  std::size_t column = 0;
  double to_si = 1.0;
};
std::optional<VelocityColumn> find_velocity(const std::vector<ForeignColumn>& columns);
// The columns for a message: 1 "Zeit [s]", 2 "Weg [mm]".
std::string list_columns(const std::vector<ForeignColumn>& columns);

}  // namespace palpate
