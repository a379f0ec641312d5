#include "models/model/grid/voxel_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/tick/features.h"

namespace palpate {

double VoxelGrid::evaluate(const double* x) const noexcept {
  std::array<std::size_t, kMaxFeatures> cell{};
  std::array<double, kMaxFeatures> fraction{};
  const std::size_t d = nodes.size();
  for (std::size_t k = 0; k < d; ++k) {
    const std::vector<double>& axis = nodes[k];
    const double at = std::clamp(x[k], axis.front(), axis.back());
    const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, at);
    cell[k] = static_cast<std::size_t>(above - axis.begin()) - 1;
    fraction[k] = (at - axis[cell[k]]) / (axis[cell[k] + 1] - axis[cell[k]]);
  }
  double sum = 0.0;
  for (std::size_t corner = 0; corner < (std::size_t{1} << d); ++corner) {
    std::size_t index = 0;
    double weight = 1.0;
    for (std::size_t k = 0; k < d; ++k) {
      const std::size_t upper = (corner >> k) & 1U;
      index = index * nodes[k].size() + cell[k] + upper;
      weight *= upper ? fraction[k] : 1.0 - fraction[k];
    }
    sum += weight * values_N[index];
  }
  return sum;
}

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
