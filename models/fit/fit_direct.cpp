#include "models/fit/fit_direct.h"

#include <limits>
#include <string>
#include <utility>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/solve/projected_kernel.h"

namespace palpate {
namespace {

// The solution of eq. 4 by the paper's truncated singular values, here eigenvalues.
Result<RbfFunction> truncated_interpolant(const Sites& sites, const FitControl& control) {
  const Eigen::Index n = sites.count();
  const Eigen::MatrixXd g = tail_matrix(tail_degree(sites.kernel), sites.points);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + g.cols(), n + g.cols());
  kernel_matrix(sites.kernel, PointArrays(sites.points), sites.points, matrix.topLeftCorner(n, n));
  matrix.bottomLeftCorner(g.cols(), n) = g.transpose();
  Eigen::VectorXd values;
  if (!symmetric_eigen(matrix, values))
    return Error{"the eigenvalues of the kernel matrix did not converge; check the recording for extreme values"};
  if (!control.may_continue(0.95)) return interrupted();
  const double rounding = static_cast<double>(values.size()) * std::numeric_limits<double>::epsilon();
  const Eigen::ArrayXd sizes = values.array().abs();
  const Eigen::ArrayXd shares = (matrix.topRows(n).transpose() * sites.target_N).array();
  const Eigen::ArrayXd inverted = (sizes > rounding * sizes.maxCoeff()).select(shares / values.array(), 0.0);
  const Eigen::VectorXd unknowns = matrix * inverted.matrix();
  return RbfFunction{sites.kernel, sites.points, unknowns.head(n), unknowns.tail(g.cols())};
}

}  // namespace

Result<RbfFunction> fit_direct(const Sites& sites, const FitControl& control) {
  if (sites.count() > kMostDirectSites)
    return Error{"a direct fit of " + std::to_string(sites.count()) + " sites is too large, at most " +
                 std::to_string(kMostDirectSites) + "; reduce the recording further or use greedy"};
  if (!control.may_continue(0.0)) return interrupted();
  const BlasThreads threads(thread_count());
  if (sites.as_2009) return truncated_interpolant(sites, control);
  const ProjectedKernel kernel(sites.kernel, sites.points, sites.row_scale);
  if (!control.may_continue(0.1)) return interrupted();
  const auto factor = kernel.cholesky(sites.smoothing);
  if (!factor) return Error{"the kernel matrix could not be factorised; check the recording for extreme values"};
  if (!control.may_continue(0.95)) return interrupted();
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  Eigen::VectorXd u = kernel.project(data);
  cholesky_solve(*factor, u);
  u = kernel.project(u);
  // S G d = S f - K u - smoothing u, whose last term is orthogonal to the columns of S G.
  const Eigen::VectorXd tail = kernel.tail_of(data - kernel.multiply_kernel(u));
  return RbfFunction{sites.kernel, sites.points, definiteness_sign(sites.kernel) * u.cwiseProduct(sites.row_scale),
                     tail};
}

const Method kDirectMethod{
    .name = "direct",
    .label = "direct",
    .colour = kNeutralColour,
    .takes = kTakesKernel,
    .expected_seconds = 3.0,
    .fit = [](const MethodTask& task, const FitControl& control) -> Result<FittedCorrection> {
      auto function = fit_direct(task.sites, control);
      if (!function) return function.error();
      return FittedCorrection{std::make_shared<const RbfCorrection>(std::move(*function)), {}, ""};
    },
};

}  // namespace palpate
