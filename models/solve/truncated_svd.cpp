#include "models/solve/truncated_svd.h"

#include <cmath>
#include <limits>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// 1 / value, or 0 for values at the level of rounding. Sets the condition number of the others.
Eigen::VectorXd inverted(const Eigen::VectorXd& values, Eigen::Index size, double& condition) {
  const double largest = values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0;
  const double least = static_cast<double>(size) * kEpsilon * largest;
  condition = 1.0;
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::abs(values(i)) <= least) continue;
    inverse(i) = 1.0 / values(i);
    condition = std::max(condition, largest / std::abs(values(i)));
  }
  return inverse;
}

}  // namespace

FittedRbf truncated_weights(const FactorisedRows& factorised, KernelKind kernel, const Eigen::MatrixXd& centres) {
  const BlasThreads one_thread(1);
  const Eigen::MatrixXd& triangle = factorised.triangle;
  const Eigen::Index columns = triangle.cols() - 1;
  const Eigen::Index n = centres.cols();
  const Eigen::Index tail = columns - n;
  // The rows of the sites in reduced form, above those of the side condition.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(triangle.rows() + tail, columns);
  matrix.topRows(triangle.rows()) = triangle.leftCols(columns);
  if (n > 0) matrix.bottomRightCorner(tail, n) = tail_matrix(tail_degree(kernel), centres).transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  right.head(triangle.rows()) = triangle.col(columns);
  const Eigen::Index rows = matrix.rows();
  Eigen::VectorXd values;
  Eigen::MatrixXd v_transposed;
  FittedRbf fitted;
  if (!singular_values(matrix, values, v_transposed)) values.setZero();
  const Eigen::VectorXd inverse = inverted(values, rows, fitted.report.condition);
  const Eigen::VectorXd unknowns = v_transposed.transpose() * inverse.cwiseProduct(matrix.transpose() * right);
  fitted.function = {kernel, centres, unknowns.tail(n), unknowns.head(tail)};
  fitted.report.centres_used = n;
  fitted.report.residual_rms = (triangle.col(columns) - triangle.leftCols(columns) * unknowns).norm() /
                               std::sqrt(static_cast<double>(factorised.sites));
  return fitted;
}

Result<FittedRbf> truncated_interpolant(const Sites& sites, KernelKind kernel, const FitControl& control) {
  if (!control.may_continue(0.0)) return interrupted();
  const Eigen::Index n = sites.count();
  const Eigen::MatrixXd g = tail_matrix(tail_degree(kernel), sites.points);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + g.cols(), n + g.cols());
  kernel_matrix(kernel, PointArrays(sites.points), sites.points, matrix.topLeftCorner(n, n));
  matrix.bottomLeftCorner(g.cols(), n) = g.transpose();
  Eigen::VectorXd values;
  const BlasThreads threads(thread_count());
  if (!symmetric_eigen(matrix, values))
    return Error{"the eigenvalues of the kernel matrix did not converge; check the recording for extreme values"};
  if (!control.may_continue(0.95)) return interrupted();
  FittedRbf fitted;
  const Eigen::VectorXd inverse = inverted(values, matrix.rows(), fitted.report.condition);
  const Eigen::VectorXd shares = matrix.topRows(n).transpose() * sites.target_N;
  const Eigen::VectorXd unknowns = matrix * inverse.cwiseProduct(shares);
  fitted.function = {kernel, sites.points, unknowns.head(n), unknowns.tail(g.cols())};
  fitted.report.centres_used = n;
  return fitted;
}

}  // namespace palpate
