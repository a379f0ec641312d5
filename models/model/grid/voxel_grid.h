// A rectilinear grid of precomputed forces, interpolated linearly in each of
// its d dimensions.
//
// Thread guarantee: immutable once filled; `evaluate` is wait-free and allocates
// nothing.
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
  // `x`: d values; outside the grid the nearest point of its box counts.
  double evaluate(const double* x) const noexcept;
};

// Errors: names the array, what was found and what was expected.
Status validate_voxel_grid(const VoxelGrid& grid, int dimension);

}  // namespace palpate
