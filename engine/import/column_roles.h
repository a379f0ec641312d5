// Which column of a foreign table is the time, the position and the force, by
// their names and units, in English, German and French and as common programs name
// them. What two columns claim with equal right is left to the user.
// Thread guarantee: slow side only.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/import/units.h"

namespace palpate {

inline constexpr std::size_t kRoles = 3;
inline constexpr std::array<const char*, kRoles> kRoleNames = {"time", "position", "force"};

// A column as the header has it; without a header the name is its number.
struct ForeignColumn {
  std::string header;  // as written
  NameAndUnit parts;
  bool constant = false;  // over the first rows: no time
};

// What the user has said of each role: a name or a number from 1; empty: guess.
using RoleRequest = std::array<std::string, kRoles>;

struct RoleChoice {
  std::array<std::optional<std::size_t>, kRoles> column;  // time: none with a given rate
  std::array<bool, kRoles> guessed{};
};

// Errors (without the file's name), each with the header and what to add: an unknown
// name; no column or several that can be the time, the position or the force; one
// column for two roles.
Result<RoleChoice> choose_columns(const std::vector<ForeignColumn>& columns, const RoleRequest& request,
                                  bool has_header, bool needs_time);

// The one column that is a measured velocity, by its name and unit ("Speed (mm/s)").
struct VelocityColumn {
  std::size_t column = 0;
  double to_si = 1.0;
};
std::optional<VelocityColumn> find_velocity(const std::vector<ForeignColumn>& columns);

// The header for a message: 1 "Zeit [s]", 2 "Weg [mm]".
std::string list_columns(const std::vector<ForeignColumn>& columns);

}  // namespace palpate
