// A rectilinear grid of precomputed forces, and the look-up in it by multilinear interpolation between the 2^d nodes
// around x. The loops are compiled for each dimension, and the reciprocal widths of the cells are precomputed.
// Thread guarantee: value type; the look-up is immutable.
// Source: Hoever & Harders (2009), section 3.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {

struct VoxelGrid {
  // For each dimension the coordinates of the nodes, ascending, at least 2 (normalised).
  std::vector<std::vector<double>> nodes;
  // Values at the nodes, the last dimension fastest.
  std::vector<double> values_N;

  std::size_t node_count() const noexcept { return values_N.size(); }
};

class VoxelLookup {
 public:
  // `grid`: 1 to kMaxFeatures dimensions, one value for each node; it is copied.
  explicit VoxelLookup(const VoxelGrid& grid);

  // The grid's value at x, d values. Coordinates outside the box are clamped to it; NaN counts as the lower edge.
  // Haptics thread, wait-free, no allocation, O(2^d + d log nodes).
  double evaluate(const double* x) const noexcept { return (this->*interpolate_)(x); }

 private:
  struct Axis {
    std::vector<double> nodes;
    std::vector<double> reciprocal_width;  // of the cell that begins at each node but the last
    std::size_t stride = 0;                // in values_
  };
  struct Cell {
    std::size_t offset = 0;
    double fraction = 0.0;
  };

  static Cell locate(const Axis& axis, double x) noexcept;
  template <int kDimension>
  double interpolate(const double* x) const noexcept;

  using Interpolate = double (VoxelLookup::*)(const double*) const noexcept;
  static Interpolate pick(int dimension);

  std::vector<double> values_;
  std::array<Axis, kMaxFeatures> axes_;
  Interpolate interpolate_ = nullptr;
};

}  // namespace palpate
