// Weights and tail for given centres, by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G are the kernel and the tail at the centres. If every site is a centre, this is the smoothing spline of
// fit_direct.h; otherwise it is the regression spline on a subset of its basis, which approaches it with more centres.
//
// With Sites::as_2009 the weights are those of the paper: eq. 8 and the rows of the side condition (eq. 3), by a
// pseudo-inverse. Singular values below max(rows, columns) x epsilon x the largest are set to 0 (the numerical rank;
// the paper gives no threshold).
//
// A QR factorisation reduces the N rows block by block to a small triangle, to which the penalty is added. It has the
// accuracy of a QR factorisation of the whole matrix, with memory O(columns^2 + block) for any N.
// Sources: Hoever & Harders (2009), eq. 8 and section 4.2.1; Wahba (1990), sections 1.3 and 7.2; Golub & Van Loan,
// Matrix Computations, 5.5.8.
// Thread guarantee: slow side, pure. The sites must pass validate_sites.
#pragma once

#include <Eigen/Core>

#include "models/model/rbf/rbf_evaluate.h"
#include "models/training/sites.h"

namespace palpate {

// `centres`: d x n, any points, n may be 0. Deterministic; uses two threads.
RbfFunction solve_weights(const Sites& sites, const Eigen::MatrixXd& centres);

}  // namespace palpate
