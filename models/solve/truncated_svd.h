// Weights by a pseudo-inverse with truncated singular values, as the paper has them. Singular values below
// max(rows, columns) x epsilon x the largest count as 0, the numerical rank (the paper gives no threshold).
// Sources: Hoever & Harders (2009), eqs. 4 and 8, sections 3 and 4.2.1; Golub & Van Loan, Matrix Computations, 5.5.8.
// Thread guarantee: slow side, pure.
#pragma once

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/solve/fit_report.h"
#include "models/solve/solve_weights.h"

namespace palpate {

// The columns of M' (eq. 8) of `centres` and of the tail, least squares; the rows of the side condition (eq. 3) are
// among those of M'.
FittedRbf truncated_weights(const FoldedRows& folded, KernelKind kernel, const Eigen::MatrixXd& centres);

// All sites as centres: eq. 4, whose matrix is symmetric, so that its singular values are those of its eigenvalues.
// O(N^3). Errors: no convergence; interrupted, which is looked at before and after.
Result<FittedRbf> truncated_interpolant(const Sites& sites, KernelKind kernel, const FitControl& control);

}  // namespace palpate
