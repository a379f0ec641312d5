// The symmetric system of direct interpolation, with the polynomial tail projected out, and the smoothing that is most
// likely in it.
//
// With S = diag(row_scale), K = sign S Phi S and q an orthonormal basis of the
// columns of S G, the weights w = sign S u of the smoothing spline
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0
// solve (P K P + smoothing) u = P S f with P = I - q q^T. On the complement of q the matrix is positive semi-definite,
// unlike the saddle matrix of eq. 4. P K P + fill q q^T is stored, which can be factorised as a whole.
// Source: Hoever & Harders (2009), eqs. 2-8; Wahba (1990) for the form.
#pragma once

#include <Eigen/Core>

#include "engine/base/result.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/training/sites.h"

namespace palpate {

class ProjectedKernel {
 public:
  // `sites` must pass validate_sites and outlive this.
  ProjectedKernel(const Sites& sites, KernelKind kernel);

  // The lower triangle of P K P + fill q q^T + smoothing I, N x N; the upper one is not set. Uses all cores.
  Eigen::MatrixXd matrix(double fill, double smoothing) const;

  // P S f, the right-hand side, and P v.
  const Eigen::VectorXd& data() const { return data_; }
  Eigen::VectorXd project(const Eigen::VectorXd& v) const { return v - q_ * (q_.transpose() * v); }

  // The function with the weights sign S u and their tail.
  RbfFunction function(const Eigen::VectorXd& u) const;

  // Mean eigenvalue of P K P; at least 1 if that is zero to rounding (all sites at one point).
  double mean_eigenvalue() const { return mean_eigenvalue_; }
  // A smaller smoothing is below the rounding errors of the matrix.
  double smallest_smoothing() const { return smallest_smoothing_; }
  Eigen::Index tail_rank() const { return q_.cols(); }

 private:
  void find_tail_space();
  Eigen::VectorXd multiply_kernel(const Eigen::VectorXd& v) const;  // K v

  const Sites& sites_;
  KernelKind kernel_;
  PointArrays points_;
  Eigen::MatrixXd q_;            // N x rank
  Eigen::MatrixXd to_tail_;      // L x rank: transforms coefficients of q into those of G
  Eigen::MatrixXd half_update_;  // V of P K P = K - q V^T - V q^T
  Eigen::VectorXd data_;
  double mean_eigenvalue_ = 1.0;
  double smallest_smoothing_ = 0.0;
};

// Selects the smoothing of a fit by maximum likelihood, from the data alone and without refitting, where
// cross-validation (models/fit/model_validation.h) has not selected it.
//
// One eigendecomposition of P K P (projected_kernel.h) for an evenly spaced subset of up to 500 sites gives the
// likelihood of every smoothing, for normal noise and a normal prior whose scale is profiled out,
//   minimise N ln(sum_i z_i^2 / (e_i + smoothing)) + sum_i ln(e_i + smoothing),
// with the eigenvalues e and the components z of the data. The largest smoothing within two units of the maximum log
// likelihood is taken. Cross-validation by samples does not see errors between clusters of samples and can select
// almost no smoothing; the likelihood does not have this fault. The smoothing is the ratio of noise variance to prior
// variance and does not depend on N, so that of the subset is valid for all sites.
// Source: Wahba (1985).
// Errors: the eigendecomposition did not converge. Deterministic. Slow side.
Result<double> choose_smoothing(const Sites& sites, KernelKind kernel);
// Whether cross-validation has selected the smoothing; its value is valid for the cubic kernel only.
inline bool is_smoothing_selected(const Sites& sites, KernelKind kernel) {
  return sites.smoothing && kernel == KernelKind::cubic;
}
// The smoothing selected by cross-validation, otherwise by maximum likelihood.
Result<double> smoothing_of(const Sites& sites, KernelKind kernel);

}  // namespace palpate
