// Weights and tail for given centres, by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G are the kernel and the tail at the centres. If every site is a centre, this is the smoothing spline of
// fit_direct.h; otherwise it is the regression spline on a subset of its basis, which approaches it with more centres.
//
// With Sites::truncation the weights are those of the paper: eq. 8 and the rows of the side condition (eq. 3), by a
// pseudo-inverse without the singular values below this share of the largest.
//
// A QR factorisation reduces the N rows block by block to a small triangle, to which the penalty is added. It has the
// accuracy of a QR factorisation of the whole matrix, with memory O(columns^2 + block) for any N.
// Sources: Hoever & Harders (2009), eq. 8 and section 4.2.1; Wahba (1990), sections 1.3 and 7.2; Golub & Van Loan,
// Matrix Computations, 5.5.8.
// Thread guarantee: slow side, pure. The sites must pass validate_sites.
#pragma once

#include <Eigen/Core>

#include "models/correction/sites.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {

// The weights, and how well they are determined.
struct SolvedWeights {
  RbfFunction function;
  Eigen::Index rank = 0;          // number of singular values kept, at most n + the size of the tail
  double condition_number = 1.0;  // the largest of them over the smallest
};

// R of a QR factorisation of row_scale (G Phi f), with the tail, the kernel at the n centres and the data, for the
// sites in `rows` (first and count): (tail + n + 1) squared. The least squares problem of the sites is that of R.
Eigen::MatrixXd reduced_rows(const Sites& sites, const Eigen::MatrixXd& centres, Eigen::Index first,
                             Eigen::Index count);
// R of the rows of two such triangles.
Eigen::MatrixXd joined_triangles(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below);

// `centres`: d x n, any points, n may be 0. Deterministic; uses two threads.
SolvedWeights solve_weights(const Sites& sites, const Eigen::MatrixXd& centres);

}  // namespace palpate
