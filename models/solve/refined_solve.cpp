#include "models/solve/refined_solve.h"

#include "engine/base/parallel.h"
#include "models/solve/lapack.h"

namespace palpate {
namespace {

// Norm over smoothing, a bound of the largest eigenvalue over the least. Above, a factor in
// single precision, 6e-8, may not exist; below, 3 to 5 iterations were seen.
constexpr double kMostCondition = 1e7;
constexpr double kResidual = 1e-12;
constexpr int kMostIterations = 20;

// Of a right side of any size: single precision has its limits.
Eigen::VectorXd solve_in_single(const ProjectedKernel& kernel, const Eigen::MatrixXf& factor,
                                const Eigen::VectorXd& right) {
  const double size = right.norm();
  Eigen::VectorXf scaled = (right / size).cast<float>();
  cholesky_solve(factor, scaled);
  return kernel.project(size * scaled.cast<double>());
}

bool conjugate_gradients(const ProjectedKernel& kernel, double smoothing, const Eigen::MatrixXf& factor,
                         Eigen::VectorXd& u) {
  const double enough = kResidual * kernel.data().norm();
  Eigen::VectorXd residual = kernel.data();
  u = Eigen::VectorXd::Zero(residual.size());
  Eigen::VectorXd along = u;
  Eigen::VectorXd last_residual = u;
  double last = 1.0;
  for (int i = 0; i < kMostIterations; ++i) {
    if (residual.norm() <= enough) return true;
    const Eigen::VectorXd step = solve_in_single(kernel, factor, residual);
    const double now = residual.dot(step);
    // The form for a preconditioner that rounds.
    along = step + (i > 0 ? step.dot(residual - last_residual) / last : 0.0) * along;
    last_residual = residual;
    last = now;
    const Eigen::VectorXd image = kernel.multiply(along) + smoothing * along;
    const double share = now / along.dot(image);
    if (!(share > 0.0)) return false;
    u += share * along;
    residual -= share * image;
  }
  return false;
}

}  // namespace

std::optional<RefinedSolution> solve_refined(const ProjectedKernel& kernel, double smoothing,
                                             const std::function<bool(double)>& may_continue) {
  Eigen::MatrixXf matrix = kernel.float_matrix(kernel.mean_eigenvalue(), smoothing);
  const BlasThreads threads(thread_count());
  const double norm = symmetric_norm(matrix);
  if (!(norm <= kMostCondition * smoothing)) return {};
  if (!cholesky_in_place(matrix, may_continue)) return {};
  RefinedSolution solution;
  if (!conjugate_gradients(kernel, smoothing, matrix, solution.u)) return {};
  solution.condition = cholesky_condition(matrix, norm);
  return solution;
}

}  // namespace palpate
