#include "models/model/grid/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate {

Status validate_voxel_grid(const VoxelGrid& grid, int dimension) {
  if (grid.nodes.size() != static_cast<std::size_t>(dimension)) {
    return Error{"grid.nodes: found " + std::to_string(grid.nodes.size()) + " axes, expected " +
                 std::to_string(dimension) + ", one per feature"};
  }
  std::size_t count = 1;
  for (const std::vector<double>& axis : grid.nodes) {
    const bool ascending =
        std::adjacent_find(axis.begin(), axis.end(), [](double a, double b) { return !(a < b); }) == axis.end();
    const bool finite = std::all_of(axis.begin(), axis.end(), [](double v) { return std::isfinite(v); });
    if (axis.size() < 2 || !ascending || !finite) {
      return Error{"grid.nodes: found an axis that is not ascending, expected at least 2 finite, ascending nodes"};
    }
    count *= axis.size();
  }
  if (grid.values_N.size() != count) {
    return Error{"grid.values_N: found " + std::to_string(grid.values_N.size()) + " values, expected " +
                 std::to_string(count)};
  }
  if (!std::all_of(grid.values_N.begin(), grid.values_N.end(), [](double v) { return std::isfinite(v); })) {
    return Error{"grid.values_N: found a non-finite number, expected finite numbers"};
  }
  return {};
}

}  // namespace palpate
