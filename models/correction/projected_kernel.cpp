#include "models/correction/projected_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/parallel.h"
#include "models/model/kernels.h"

namespace palpate {

namespace {

// The 1-norm of a symmetric matrix of which only the lower triangle is set.
double lower_norm(const Eigen::MatrixXd& lower) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(lower.cols());
  for (Eigen::Index k = 0; k < lower.cols(); ++k) {
    const auto below = lower.col(k).tail(lower.rows() - k - 1);
    sums(k) += std::abs(lower(k, k)) + below.lpNorm<1>();
    sums.tail(below.size()) += below.cwiseAbs();
  }
  return sums.maxCoeff();
}

}  // namespace

ProjectedKernel::ProjectedKernel(KernelKind kernel, const Eigen::MatrixXd& points, const Eigen::VectorXd& scale)
    : kernel_(kernel), points_(points), arrays_(points), scale_(scale) {
  // Directions weaker than this come from a constant or repeated feature.
  constexpr double kWeakestDirection = 1e-10;
  Eigen::MatrixXd tail = scale.asDiagonal() * tail_matrix(tail_degree(kernel), points);
  tail_scale_ = tail.colwise().norm().transpose();
  tail_scale_ = (tail_scale_.array() > 0.0).select(tail_scale_, 1.0);
  tail.array().rowwise() /= tail_scale_.transpose().array();
  tail_.setThreshold(kWeakestDirection);
  tail_.compute(tail);
  q_ = tail_.householderQ() * Eigen::MatrixXd::Identity(points.cols(), tail_.rank());
  Eigen::MatrixXd kq(q_.rows(), q_.cols());
  for (Eigen::Index k = 0; k < q_.cols(); ++k) kq.col(k) = multiply_kernel(q_.col(k));
  const Eigen::MatrixXd inner = q_.transpose() * kq;
  half_update_ = kq - 0.5 * q_ * inner;
  // The kernels vanish at r = 0, so all of the trace comes from the update.
  const double trace = -2.0 * q_.cwiseProduct(half_update_).sum();
  const double size = inner.norm();
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * (std::abs(trace) + size);
  const bool nothing = !(trace > 1e3 * rounding) || trace < 1e-60;
  mean_eigenvalue_ = nothing ? std::max(1.0, size) : trace / static_cast<double>(points.cols());
  smallest_smoothing_ = nothing ? mean_eigenvalue_ : rounding;
}

Eigen::VectorXd ProjectedKernel::multiply_kernel(const Eigen::VectorXd& v) const {
  const Eigen::VectorXd product = kernel_product(kernel_, points_, v.cwiseProduct(scale_));
  return definiteness_sign(kernel_) * product.cwiseProduct(scale_);
}

void ProjectedKernel::project_rows(MatrixRef matrix) const {
  Eigen::MatrixXd along(matrix.rows(), q_.cols());
  multiply(matrix, false, q_, false, 1.0, 0.0, along);
  multiply(along, false, q_, true, -1.0, 1.0, matrix);
}

Eigen::MatrixXd ProjectedKernel::matrix(double fill, double smoothing) const {
  constexpr Eigen::Index kBlock = 64;  // columns at a time; a multiple of 8
  const Eigen::Index count = points_.cols();
  const auto blocks = static_cast<int>((count + kBlock - 1) / kBlock);
  const Eigen::MatrixXd update = half_update_ - 0.5 * fill * q_;
  Eigen::MatrixXd matrix(count, count);
  const BlasThreads one_thread(1);
  parallel_for(blocks, [&](int block) {
    const Eigen::Index first = block * kBlock, columns = std::min(kBlock, count - first), rows = count - first;
    auto part = matrix.block(first, first, rows, columns);
    kernel_matrix(kernel_, arrays_, points_.middleCols(first, columns), part, first);
    part.array().colwise() *= scale_.tail(rows).array();
    part.array().rowwise() *= definiteness_sign(kernel_) * scale_.segment(first, columns).transpose().array();
    multiply(q_.bottomRows(rows), false, update.middleRows(first, columns), true, -1.0, 1.0, part);
    multiply(update.bottomRows(rows), false, q_.middleRows(first, columns), true, -1.0, 1.0, part);
  });
  matrix.diagonal().array() += smoothing;
  return matrix;
}

std::optional<ProjectedKernel::Factor> ProjectedKernel::cholesky(double smoothing, const FitControl& control) const {
  smoothing = std::max(smoothing, smallest_smoothing_);
  for (int attempt = 0; attempt < 8; ++attempt, smoothing *= 10.0) {
    Factor factor{matrix(mean_eigenvalue_, smoothing)};
    factor.norm = lower_norm(factor.lower);
    if (cholesky_in_place(factor.lower, control)) return factor;
    if (!control.may_continue()) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace palpate
