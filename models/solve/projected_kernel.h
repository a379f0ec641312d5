// The symmetric system of direct interpolation, with the polynomial tail projected out.
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

}  // namespace palpate
