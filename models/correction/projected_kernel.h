// The kernel matrix between points, with the polynomial tail projected out.
//
// With S = diag(scale), K = sign S Phi S, q an orthonormal basis of the columns of S G and P = I - q q^T: if u = P u,
// the weights w = sign S u satisfy the side condition G^T w = 0, and their roughness w^T (sign Phi) w is u^T P K P u >=
// 0. With all sites as centres the smoothing spline solves (P K P + smoothing I) u = P S f; with some the matrix of the
// centres, with S = I, is the penalty.
// Source: Hoever & Harders (2009), eqs. 2-8; Wahba (1990) for the form. Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <optional>

#include "models/correction/sites.h"
#include "models/linear/lapack.h"
#include "models/model/correction.h"

namespace palpate {

class ProjectedKernel {
 public:
  // `points`: d x N, N >= 1; `scale`: N factors >= 0.
  ProjectedKernel(KernelKind kernel, const Eigen::MatrixXd& points, const Eigen::VectorXd& scale);

  // The lower triangle of P K P + fill q q^T + smoothing I, N x N; the upper one is not set. Uses all cores.
  Eigen::MatrixXd matrix(double fill, double smoothing) const;
  // The Cholesky factor of that matrix with the mean eigenvalue as fill. If rounding prevents it, the smoothing is
  // multiplied by ten until the factor exists; none after eight attempts, or if interrupted.
  struct Factor {
    Eigen::MatrixXd lower;
    double norm = 0.0;  // the 1-norm of the matrix
  };
  std::optional<Factor> cholesky(double smoothing, const FitControl& control = {}) const;

  // P v.
  Eigen::VectorXd project(const Eigen::VectorXd& v) const { return v - q_ * (q_.transpose() * v); }
  // Replaces a matrix with N columns by its product with P.
  void project_rows(MatrixRef matrix) const;
  // K v.
  Eigen::VectorXd multiply_kernel(const Eigen::VectorXd& v) const;
  // The least squares solution d of S G d = v.
  Eigen::VectorXd tail_of(const Eigen::VectorXd& v) const { return tail_.solve(v).cwiseQuotient(tail_scale_); }

  // Mean eigenvalue of P K P; at least 1 if that is zero to rounding (all points are the same).
  double mean_eigenvalue() const { return mean_eigenvalue_; }
  // The smallest smoothing above the rounding errors of the matrix.
  double smallest_smoothing() const { return smallest_smoothing_; }

 private:
  KernelKind kernel_;
  Eigen::MatrixXd points_;
  PointArrays arrays_;  // the same points
  Eigen::VectorXd scale_;
  Eigen::VectorXd tail_scale_;                                    // the length of each column of S G
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> tail_;  // of S G with columns of length 1
  Eigen::MatrixXd q_;                                             // N x rank
  Eigen::MatrixXd half_update_;                                   // V of P K P = K - q V^T - V q^T
  double mean_eigenvalue_ = 1.0, smallest_smoothing_ = 0.0;
};

}  // namespace palpate
