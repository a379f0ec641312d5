// Fast look-up in a VoxelGrid.
//
// The same numbers as VoxelGrid::evaluate to rounding, several times faster:
// the loops are compiled for each dimension, a small table per axis gives the
// cell without a search, however unevenly the nodes are spaced, and widths are
// divided by beforehand.
// Source: Hoever & Harders (2009), section 3.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/features.h"
#include "models/model/grid/voxel_grid.h"

namespace palpate {

class VoxelLookup {
 public:
  // `grid` must pass validate_voxel_grid; it is copied.
  explicit VoxelLookup(const VoxelGrid& grid);

  // The grid's value at x, d values; coordinates outside the box count as
  // those of its edge, NaN as the lower edge. Haptics thread, wait-free, no
  // allocation, O(2^d).
  double evaluate(const double* x) const noexcept { return (this->*interpolate_)(x); }

  int dimension() const noexcept { return dimension_; }

 private:
  struct Node {
    double at = 0.0;
    double reciprocal_width = 0.0;  // of the cell that begins here
  };
  // One dimension: cells, and a table from equal intervals to the cell in
  // which the interval starts. Intervals are no longer than the shortest cell
  // where the table can be, so that at most one step up remains. A last node at
  // infinity ends every search.
  struct Axis {
    double low = 0.0;
    double high = 0.0;
    double intervals_per_unit = 0.0;
    std::vector<std::uint32_t> cell_at;
    std::vector<Node> nodes;
    std::size_t stride = 0;  // in values
  };
  struct Place {
    std::size_t offset = 0;
    double fraction = 0.0;
  };

  static Axis make_axis(const std::vector<double>& nodes, std::size_t stride);
  static Place locate(const Axis& axis, double x) noexcept;
  template <int kDimension>
  double interpolate(const double* x) const noexcept;

  using Interpolate = double (VoxelLookup::*)(const double*) const noexcept;
  static Interpolate pick(int dimension);

  std::vector<double> values_;
  std::array<Axis, kMaxFeatures> axes_;
  Interpolate interpolate_ = nullptr;
  int dimension_ = 0;
};

}  // namespace palpate
