// Weights by a pseudo-inverse with truncated singular values, as in the paper. Singular values below
// max(rows, columns) x epsilon x the largest are set to 0 (the numerical rank; the paper gives no threshold).
// Sources: Hoever & Harders (2009), eqs. 4 and 8, sections 3 and 4.2.1; Golub & Van Loan, Matrix Computations, 5.5.8.
// Thread guarantee: slow side, pure.
#pragma once

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/solve/solve_weights.h"

namespace palpate {

// Least squares with the matrix M' (eq. 8) of `centres` and the tail, including the rows of the side condition (eq. 3).
FittedRbf truncated_weights(const FactorisedRows& factorised, KernelKind kernel, const Eigen::MatrixXd& centres);

// Interpolation with all sites as centres: eq. 4, whose matrix is symmetric, so its eigenvalues give the singular
// values. O(N^3). Errors: no convergence; interrupted, checked only before and after the decomposition.
Result<FittedRbf> truncated_interpolant(const Sites& sites, KernelKind kernel, const FitControl& control);

}  // namespace palpate
