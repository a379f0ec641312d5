#include "models/solve/projected_kernel.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"

namespace palpate {
namespace {

// The largest subset: its eigendecomposition takes some 40 ms.
constexpr Eigen::Index kSmoothingSubset = 500;
// The range of the search relative to the mean eigenvalue, in quarters of a decade.
constexpr int kLowestQuarter = -48;
constexpr int kHighestQuarter = 8;

}  // namespace

ProjectedKernel::ProjectedKernel(const Sites& sites, KernelKind kernel)
    : sites_(sites), kernel_(kernel), points_(sites.points) {
  find_tail_space();
  data_ = project(sites.target_N.cwiseProduct(sites.row_scale));
  Eigen::MatrixXd kq(q_.rows(), q_.cols());
  for (Eigen::Index k = 0; k < q_.cols(); ++k) kq.col(k) = multiply_kernel(q_.col(k));
  const Eigen::MatrixXd inner = q_.transpose() * kq;
  half_update_ = kq - 0.5 * q_ * inner;
  // The kernels vanish at r = 0, so all of the trace comes from the update.
  const double trace = -2.0 * q_.cwiseProduct(half_update_).sum();
  const auto count = static_cast<double>(sites.count());
  const double size = inner.norm();
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * (std::abs(trace) + size);
  const bool nothing = !(trace > 1e3 * rounding) || trace < 1e-60;
  mean_eigenvalue_ = nothing ? std::max(1.0, size) : trace / count;
  smallest_smoothing_ = nothing ? mean_eigenvalue_ : rounding;
}

void ProjectedKernel::find_tail_space() {
  // Directions weaker than this come from a constant or repeated feature.
  constexpr double kWeakestDirection = 1e-10;
  Eigen::MatrixXd tail = tail_matrix(tail_degree(kernel_), sites_.points);
  tail.array().colwise() *= sites_.row_scale.array();
  Eigen::VectorXd scale = tail.colwise().norm().transpose();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  tail.array().rowwise() /= scale.transpose().array();
  const Eigen::Index small = std::min(tail.rows(), tail.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(tail);
  const Eigen::MatrixXd thin_q = qr.householderQ() * Eigen::MatrixXd::Identity(tail.rows(), small);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(small).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(r, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& sizes = parts.singularValues();
  const Eigen::Index rank = (sizes.array() > kWeakestDirection * std::max(sizes[0], 1e-300)).count();
  q_ = thin_q * parts.matrixU().leftCols(rank);
  to_tail_ = parts.matrixV().leftCols(rank) * sizes.head(rank).cwiseInverse().asDiagonal();
  to_tail_.array().colwise() /= scale.array();
}

Eigen::VectorXd ProjectedKernel::multiply_kernel(const Eigen::VectorXd& v) const {
  const Eigen::VectorXd product = kernel_product(kernel_, sites_.points, v.cwiseProduct(sites_.row_scale));
  return definiteness_sign(kernel_) * product.cwiseProduct(sites_.row_scale);
}

Eigen::MatrixXd ProjectedKernel::matrix(double fill, double smoothing) const {
  constexpr Eigen::Index kBlock = 64;  // columns at a time; a multiple of 8
  const Eigen::Index count = sites_.count();
  const auto blocks = static_cast<int>((count + kBlock - 1) / kBlock);
  const Eigen::MatrixXd update = half_update_ - 0.5 * fill * q_;
  Eigen::MatrixXd matrix(count, count);
  const BlasThreads one_thread(1);
  parallel_for(blocks, [&](int block) {
    const Eigen::Index first = block * kBlock;
    const Eigen::Index columns = std::min(kBlock, count - first);
    const Eigen::Index rows = count - first;
    auto part = matrix.block(first, first, rows, columns);
    kernel_matrix(kernel_, points_, sites_.points.middleCols(first, columns), part, first);
    part.array().colwise() *= sites_.row_scale.tail(rows).array();
    part.array().rowwise() *= definiteness_sign(kernel_) * sites_.row_scale.segment(first, columns).transpose().array();
    multiply(q_.bottomRows(rows), false, update.middleRows(first, columns), true, -1.0, 1.0, part);
    multiply(update.bottomRows(rows), false, q_.middleRows(first, columns), true, -1.0, 1.0, part);
  });
  matrix.diagonal().array() += smoothing;
  return matrix;
}

RbfFunction ProjectedKernel::function(const Eigen::VectorXd& u) const {
  RbfFunction function;
  function.kernel = kernel_;
  function.centres = sites_.points;
  function.weights = definiteness_sign(kernel_) * u.cwiseProduct(sites_.row_scale);
  // S G d = S f - K u - smoothing u, and q^T u = 0.
  const Eigen::VectorXd rest = sites_.target_N.cwiseProduct(sites_.row_scale) - multiply_kernel(u);
  function.tail = to_tail_ * (q_.transpose() * rest);
  return function;
}

Result<double> choose_smoothing(const Sites& sites, KernelKind kernel) {
  const Sites subset = even_subset(sites, kSmoothingSubset);
  const ProjectedKernel projected(subset, kernel);
  const double unit = projected.mean_eigenvalue();
  const Eigen::Index rank = subset.count() - projected.tail_rank();
  if (rank == 0) return projected.smallest_smoothing();
  // The directions of the tail get an eigenvalue above all others, so that they come last.
  Eigen::MatrixXd vectors = projected.matrix(10.0 * unit * static_cast<double>(subset.count()), 0.0);
  Eigen::VectorXd values;
  const BlasThreads one_thread(1);
  if (!symmetric_eigen(vectors, values))
    return Error{"the eigendecomposition did not converge; check the recording for extreme values"};
  const Eigen::ArrayXd eigenvalues = values.head(rank).cwiseMax(0.0).array();
  const Eigen::ArrayXd z_squared = (vectors.leftCols(rank).transpose() * projected.data()).array().square();
  // exp(2 L / rank), where L is the negative log likelihood.
  const auto likelihood = [&](double smoothing) {
    const Eigen::ArrayXd variances = eigenvalues + smoothing;
    return (z_squared / variances).mean() * std::exp(variances.log().mean());
  };
  // The largest smoothing within two units of log likelihood of the best is chosen: it gives the best conditioned
  // system.
  const double as_good = 1.0 + 4.0 / static_cast<double>(rank);
  double chosen = projected.smallest_smoothing();
  double lowest = likelihood(chosen);
  std::vector<double> tried;
  for (int quarter = kLowestQuarter; quarter <= kHighestQuarter; ++quarter) {
    const double smoothing = unit * std::pow(10.0, 0.25 * quarter);
    if (smoothing < projected.smallest_smoothing()) continue;
    tried.push_back(smoothing);
    lowest = std::min(lowest, likelihood(smoothing));
  }
  for (const double smoothing : tried) {
    if (likelihood(smoothing) <= as_good * lowest) chosen = smoothing;
  }
  return chosen;
}

Result<double> smoothing_of(const Sites& sites, KernelKind kernel) {
  if (is_smoothing_selected(sites, kernel)) return *sites.smoothing;
  return choose_smoothing(sites, kernel);
}

}  // namespace palpate
