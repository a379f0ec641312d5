// A rectilinear grid of precomputed forces, interpolated linearly in each of
// its d dimensions (voxel_lookup.h).
// Thread guarantee: a value type.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

struct VoxelGrid {
  // Per dimension: the node coordinates, ascending, at least 2 (normalised).
  std::vector<std::vector<double>> nodes;
  // Values at the nodes, the last dimension fastest.
  std::vector<double> values_N;

  std::size_t node_count() const noexcept { return values_N.size(); }
};

// Errors: names the array, what was found and what was expected.
Status validate_voxel_grid(const VoxelGrid& grid, int dimension);

}  // namespace palpate
