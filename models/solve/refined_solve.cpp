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

class SingleFactor {
 public:
  SingleFactor(const ProjectedKernel& kernel, const Eigen::MatrixXf& factor) : kernel_(kernel), factor_(factor) {}

  // Of a vector of any size: single precision has its limits.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    const double size = right.norm();
    Eigen::VectorXf scaled = (right / size).cast<float>();
    cholesky_solve(factor_, scaled);
    return kernel_.project(size * scaled.cast<double>());
  }

 private:
  const ProjectedKernel& kernel_;
  const Eigen::MatrixXf& factor_;
};

bool conjugate_gradients(const ProjectedKernel& kernel, double smoothing, const SingleFactor& factor,
                         Eigen::VectorXd& u) {
  const double enough = kResidual * kernel.data().norm();
  Eigen::VectorXd residual = kernel.data();
  u = Eigen::VectorXd::Zero(residual.size());
  Eigen::VectorXd along = u;
  Eigen::VectorXd last_residual = u;
  double last = 1.0;
  for (int i = 0; i < kMostIterations; ++i) {
    if (residual.norm() <= enough) return true;
    const Eigen::VectorXd step = factor.solve(residual);
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

RefinedOutcome solve_refined(const ProjectedKernel& kernel, double smoothing,
                             const std::function<bool(double)>& may_continue, RefinedSolution& out) {
  Eigen::MatrixXf matrix = kernel.float_matrix(kernel.mean_eigenvalue(), smoothing);
  const BlasThreads threads(thread_count());
  const double norm = symmetric_norm(matrix);
  if (!(norm <= kMostCondition * smoothing)) return RefinedOutcome::not_for_single;
  bool interrupted = false;
  const auto asked = [&](double share) {
    interrupted = !may_continue(share);
    return !interrupted;
  };
  if (!cholesky_in_place(matrix, asked))
    return interrupted ? RefinedOutcome::interrupted : RefinedOutcome::not_for_single;
  const SingleFactor factor(kernel, matrix);
  if (!conjugate_gradients(kernel, smoothing, factor, out.u)) return RefinedOutcome::not_for_single;
  out.condition = cholesky_condition(matrix, norm);
  return RefinedOutcome::solved;
}

}  // namespace palpate
