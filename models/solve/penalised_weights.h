// Weights and tail for given centres by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G the kernel and the tail at the centres; h is then multiplied by the
// sites' strength. With every site a centre this
// is the smoothing spline of fit_direct.h; with fewer it is the regression spline
// on a subset of its basis, and comes closer to it the more there are. Unknowns that the
// sites tell (FoldedRows::told) have neither penalty nor side condition; a ridge of 1e-6 of
// the columns' length keeps centres at one point apart.
// Source: Wahba (1990), sections 1.3 and 7.2.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>

#include "models/linear/lapack.h"
#include "models/model/rbf/kernels.h"
#include "models/solve/fit_report.h"
#include "models/solve/solve_weights.h"

namespace palpate {

// The part of w-space that is orthogonal to the tail at the centres, and the
// penalty in it.
struct PenaltySpace {
  Eigen::Index free = 0;    // n - rank G
  Eigen::MatrixXd penalty;  // Z^T (sign Phi) Z, positive semidefinite
  // Its orthonormal columns Z are the last `free` of I - u v^T, both n x rank G: products
  // with them take a fortieth of those with a matrix.
  Eigen::MatrixXd u;
  Eigen::MatrixXd v;
};
PenaltySpace penalty_space(KernelKind kernel, const Eigen::MatrixXd& centres);
// Replaces the first `free` columns of `matrix`, of n columns, by those of its product with Z.
void multiply_by_basis(MatrixRef matrix, const PenaltySpace& space);

FittedRbf penalised_weights(const FoldedRows& folded, KernelKind kernel, const Eigen::MatrixXd& centres);

}  // namespace palpate
