// The correction h(u) of the trend, a function of the normalised features: radial basis functions (Hoever & Harders
// 2009, eq. 2), or a grid of precomputed values (section 3). Only fits, the model file and the exported C distinguish
// them. Thread guarantee: a Correction is immutable and may be shared by any threads; `evaluate` is as in ForceModel.
//
// Each phi has a relative error of at most 4 ulp (thin-plate: 8 ulp of r^2 (1 + |log r|)). Two instruction sets
// (vector_loops.h), or the defining sum, differ by at most 32 eps (sum_j |w_j phi_j| + sum_k |d_k g_k|), eps = 2^-53.
// Coordinates and weights below kTiny count as 0 and distances below 1e-18 as 1e-18, so no intermediate value is
// denormal unless the result is. Results are finite while |x| and |centres| are below 1e60 and the result is below
// 1e300.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/model/vector_loops.h"

namespace palpate {

class Correction {
 public:
  virtual ~Correction() = default;

  // h(u) in newtons. `u`: one normalised value per feature. Haptics thread, wait-free, no allocation.
  virtual double evaluate(const double* u) const noexcept = 0;
  // The number of centres, or of nodes of a grid.
  virtual int size() const noexcept = 0;
};

// Null: the model is its trend alone.
using CorrectionPtr = std::shared_ptr<const Correction>;

// ---- radial basis functions ----

// The data of h(x) = sum_j w_j phi(|x - q_j|) + sum_k d_k g_k(x).
struct RbfFunction {
  KernelKind kernel = KernelKind::cubic;
  Eigen::MatrixXd centres;  // q, d x n
  Eigen::VectorXd weights;  // w, n
  Eigen::VectorXd tail;     // d_k: tail_size(tail_degree(kernel), d) values, see kernels.h

  int dimension() const { return static_cast<int>(centres.rows()); }
  Eigen::Index centre_count() const { return centres.cols(); }
};

// Points as structure-of-arrays, padded with points at the origin. Immutable.
class PointArrays {
 public:
  PointArrays() = default;
  // `points`: d x N, d from 1 to kMaxFeatures.
  explicit PointArrays(const Eigen::MatrixXd& points);

  const simd::Points& view() const noexcept { return view_; }
  Eigen::Index count() const noexcept { return count_; }

 private:
  std::shared_ptr<const Eigen::MatrixXd> memory_;  // shared by copies
  simd::Points view_;
  Eigen::Index count_ = 0;
};

class RbfCorrection final : public Correction {
 public:
  // `function`: one weight for each centre, and the tail of its kernel.
  explicit RbfCorrection(RbfFunction function);

  // O(n).
  double evaluate(const double* x) const noexcept override {
    return evaluate_(centres_.view(), weights_.data(), function_.tail.data(), x);
  }
  int size() const noexcept override { return static_cast<int>(function_.centre_count()); }

  // out[i] = h(points.col(i)). `points`: d x M. Slow side; uses all cores for large M. Values are bit-identical to
  // those of evaluate().
  void evaluate_many(const Eigen::MatrixXd& points, Eigen::VectorXd& out) const;

  const RbfFunction& function() const noexcept { return function_; }

 private:
  RbfFunction function_;
  PointArrays centres_;
  Eigen::VectorXd weights_;  // padded
  decltype(simd::Loops::evaluate) evaluate_ = nullptr;
};

// Rows of the matrix Phi of eq. 5,
//   out(i, j) = phi(|points.col(first_row + i) - centres.col(j)|)
// `out`: rows x n, contiguous columns; `first_row`: a multiple of 8. Runs on the calling thread; several threads may
// fill parts of a matrix at once.
void kernel_matrix(KernelKind kind, const PointArrays& points, const Eigen::Ref<const Eigen::MatrixXd>& centres,
                   Eigen::Ref<Eigen::MatrixXd> out, Eigen::Index first_row = 0);
// Phi v, the product with the kernel matrix of a point set, without storing the matrix. `points`: d x N; `v`: N values.
// Uses all cores; the result does not depend on their number.
Eigen::VectorXd kernel_product(KernelKind kind, const Eigen::MatrixXd& points, const Eigen::VectorXd& v);

// ---- a rectilinear grid ----

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

// Multilinear interpolation between the 2^d nodes around x, with loops that are compiled for each dimension.
class GridCorrection final : public Correction {
 public:
  // `grid`: 1 to kMaxFeatures dimensions, one value for each node.
  explicit GridCorrection(VoxelGrid grid);
  GridCorrection(const GridCorrection&) = delete;  // nodes_ refers to grid_

  // Coordinates outside the box are clamped to it; NaN counts as the lower edge. O(2^d + d log nodes).
  double evaluate(const double* x) const noexcept override { return (this->*interpolate_)(x); }
  int size() const noexcept override { return static_cast<int>(grid_.values_N.size()); }

  const VoxelGrid& grid() const noexcept { return grid_; }

 private:
  template <int kDimension>
  double interpolate(const double* x) const noexcept;

  VoxelGrid grid_;
  std::array<std::span<const double>, kMaxFeatures> nodes_;
  std::array<std::size_t, kMaxFeatures> stride_{};                  // of each dimension in values_N
  std::array<std::vector<double>, kMaxFeatures> reciprocal_width_;  // of the cell that begins at each node but the last
  double (GridCorrection::*interpolate_)(const double*) const noexcept = nullptr;
};

// The data of a correction of this kind, else null.
const RbfFunction* rbf_of(const CorrectionPtr& correction);
const VoxelGrid* grid_of(const CorrectionPtr& correction);

}  // namespace palpate
