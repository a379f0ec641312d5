// A rectilinear grid of precomputed forces, and the look-up in it by multilinear interpolation between the 2^d nodes
// around x. The loops are compiled for each dimension, and the reciprocal widths of the cells are precomputed.
// Thread guarantee: value type; the look-up is immutable.
// Source: Hoever & Harders (2009), section 3.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/model/correction.h"

namespace palpate {

struct VoxelGrid {
  // For each dimension the coordinates of the nodes, ascending, at least 2 (normalised).
  std::vector<std::vector<double>> nodes;
  // Values at the nodes, the last dimension fastest.
  std::vector<double> values_N;
};

// Sets out[i] to the value at points.col(i), for a batch of points, d x M.
using BatchFunction = std::function<void(const Eigen::MatrixXd& points, Eigen::VectorXd& out)>;
// Sets the values of a grid to those of the function at its nodes. Errors: interrupted. Slow side.
Status fill_grid(VoxelGrid& grid, const BatchFunction& function, const FitControl& control = {});

// The grid as the correction of a model. Immutable.
class GridCorrection final : public Correction {
 public:
  // `grid`: 1 to kMaxFeatures dimensions, one value for each node.
  explicit GridCorrection(VoxelGrid grid);
  GridCorrection(const GridCorrection&) = delete;  // axes_ refers to grid_

  // The grid's value at x, d values. Coordinates outside the box are clamped to it; NaN counts as the lower edge.
  // Haptics thread, wait-free, no allocation, O(2^d + d log nodes).
  double evaluate(const double* x) const noexcept override { return (this->*interpolate_)(x); }
  int size() const noexcept override { return static_cast<int>(grid_.values_N.size()); }

  const VoxelGrid& grid() const noexcept { return grid_; }

 private:
  struct Axis {
    std::span<const double> nodes;
    std::vector<double> reciprocal_width;  // of the cell that begins at each node but the last
    std::size_t stride = 0;                // in values_N
  };
  struct Cell {
    std::size_t offset = 0;
    double fraction = 0.0;
  };

  static Cell locate(const Axis& axis, double x) noexcept;
  template <int kDimension>
  double interpolate(const double* x) const noexcept;

  using Interpolate = double (GridCorrection::*)(const double*) const noexcept;
  static Interpolate pick(std::size_t dimension);

  VoxelGrid grid_;
  std::array<Axis, kMaxFeatures> axes_;
  Interpolate interpolate_ = nullptr;
};

// The grid of a correction of this kind, else null.
const VoxelGrid* grid_of(const CorrectionPtr& correction);

}  // namespace palpate
