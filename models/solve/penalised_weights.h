// Weights and tail for given centres by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G are the kernel and the tail at the centres; h is then multiplied by the sites' strength. If every site is
// a centre, this is the smoothing spline of fit_direct.h, otherwise the regression spline on a subset of its basis,
// which approaches it with more centres. Where the sites determine the unknowns (FactorisedRows::plain_unknowns_limit),
// there is neither penalty nor side condition; a ridge of 1e-6 of the columns' length separates duplicate centres.
// Source: Wahba (1990), sections 1.3 and 7.2.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>

#include "models/linear/lapack.h"
#include "models/model/rbf/kernels.h"
#include "models/solve/fit_report.h"
#include "models/solve/solve_weights.h"

namespace palpate {

// The subspace of weights that are orthogonal to the tail at the centres, and the penalty in it.
struct PenaltySpace {
  Eigen::Index free = 0;    // n - rank G
  Eigen::MatrixXd penalty;  // Z^T (sign Phi) Z, positive semidefinite
  // The orthonormal basis Z consists of the last `free` columns of I - u v^T, both n x rank G: products in this form
  // take a fortieth of those with a matrix.
  Eigen::MatrixXd u;
  Eigen::MatrixXd v;
};
PenaltySpace penalty_space(KernelKind kernel, const Eigen::MatrixXd& centres);
// Replaces the first `free` columns of `matrix`, which has n columns, by its product with Z.
void multiply_by_basis(MatrixRef matrix, const PenaltySpace& space);

// Errors: none. The condition and the root mean square of the residual are in the report.
FittedRbf penalised_weights(const FactorisedRows& factorised, KernelKind kernel, const Eigen::MatrixXd& centres);

}  // namespace palpate
