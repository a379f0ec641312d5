// Vectorised evaluation of radial basis functions for the tick, the grid and the fits. The instruction set (AVX-512,
// AVX2, SSE4, NEON or plain) is selected when an object is built, not per call.
//
// Accuracy: each phi has a relative error of at most 4 ulp (thin-plate: 8 ulp of r^2 (1 + |log r|)); distances below
// 1e-18 are set to 1e-18. Sums are taken in double, in an order that depends on the instruction set. The results of
// two instruction sets, or of the defining sum, differ by at most 32 eps (sum_j |w_j phi_j| + sum_k |d_k g_k|), eps =
// 2^-53.
//
// Denormals: coordinates and weights below 1e-100 count as 0 and squared distances below 1e-36 are set to it, so no
// intermediate value is denormal unless the result is. Results are finite while |x| and |centres| are below 1e60 and
// the result is below 1e300; a non-finite x gives a non-finite result.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "engine/tick/features.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_function.h"
#include "models/model/rbf/rbf_simd.h"

namespace palpate {

// Points as structure-of-arrays, 64-byte aligned, padded with points at the
// origin. Immutable.
class PointArrays {
 public:
  PointArrays() = default;
  // `points`: d x N, d from 1 to kMaxFeatures.
  explicit PointArrays(const Eigen::MatrixXd& points);

  const simd::Points& view() const noexcept { return view_; }
  Eigen::Index count() const noexcept { return count_; }

 private:
  std::shared_ptr<const double[]> memory_;  // shared by copies
  simd::Points view_;
  Eigen::Index count_ = 0;
};

// h(x) of eq. 2. Immutable; may be used by several threads at once.
class RbfEvaluator {
 public:
  // `function`: one weight for each centre, and the tail of its kernel.
  explicit RbfEvaluator(const RbfFunction& function);

  // h(x) in newtons. `x`: d values, normalised. Haptics thread, wait-free, O(n), no allocation.
  double evaluate(const double* x) const noexcept {
    return evaluate_(centres_.view(), weights_.get(), tail_.data(), x);
  }

  // out[i] = h(points.col(i)). `points`: d x M. Slow side; uses all cores for large M. Values are bit-identical to
  // those of evaluate().
  void evaluate_many(const Eigen::MatrixXd& points, Eigen::VectorXd& out) const;

  int dimension() const noexcept { return dimension_; }
  Eigen::Index centre_count() const noexcept { return centres_.count(); }

 private:
  PointArrays centres_;
  std::shared_ptr<const double[]> weights_;
  std::vector<double> tail_;
  int dimension_ = 0;
  simd::EvaluateFunction evaluate_ = nullptr;
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

}  // namespace palpate
