// Vectorised evaluation of radial basis functions for the tick, the grid and the fits. The instruction set
// (vector_loops.h) is selected when an object is built.
//
// Each phi has a relative error of at most 4 ulp (thin-plate: 8 ulp of r^2 (1 + |log r|)). Two instruction sets, or the
// defining sum, differ by at most 32 eps (sum_j |w_j phi_j| + sum_k |d_k g_k|), eps = 2^-53. Coordinates and weights
// below kTiny count as 0 and distances below 1e-18 as 1e-18, so no intermediate value is denormal unless the result is.
// Results are finite while |x| and |centres| are below 1e60 and the result is below 1e300.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "engine/tick/features.h"
#include "models/model/correction.h"
#include "models/model/rbf/kernels.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/vector_loops.h"

namespace palpate {

// The data of h(x) = sum_j w_j phi(|x - q_j|) + sum_k d_k g_k(x).
// Source: Hoever & Harders (2009), eq. 2.
struct RbfFunction {
  KernelKind kernel = KernelKind::cubic;
  Eigen::MatrixXd centres;  // q, d x n
  Eigen::VectorXd weights;  // w, n
  Eigen::VectorXd tail;     // d_k: tail_size(tail_degree(kernel), d) values, see polynomial_tail.h

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

// h(x) as the correction of a model, and for fits. Immutable; may be used by several threads at once.
class RbfCorrection final : public Correction {
 public:
  // `function`: one weight for each centre, and the tail of its kernel.
  explicit RbfCorrection(RbfFunction function);

  // h(x) in newtons. `x`: d values, normalised. Haptics thread, wait-free, O(n), no allocation.
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
  simd::EvaluateFunction evaluate_ = nullptr;
};

// The function of a correction of this kind, else null.
const RbfFunction* rbf_of(const CorrectionPtr& correction);
// Rows of the matrix Phi of eq. 5,
//   out(i, j) = phi(|points.col(first_row + i) - centres.col(j)|)
// `out`: rows x n, contiguous columns; `first_row`: a multiple of 8. Runs on the calling thread; several threads may
// fill parts of a matrix at once.
void kernel_matrix(KernelKind kind, const PointArrays& points, const Eigen::Ref<const Eigen::MatrixXd>& centres,
                   Eigen::Ref<Eigen::MatrixXd> out, Eigen::Index first_row = 0);
// Phi v, the product with the kernel matrix of a point set, without storing the matrix. `points`: d x N; `v`: N values.
// Uses all cores; the result does not depend on their number.
Eigen::VectorXd kernel_product(KernelKind kind, const Eigen::MatrixXd& points, const Eigen::VectorXd& v);

}  // namespace palpate
