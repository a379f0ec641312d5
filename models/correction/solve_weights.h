// Weights and tail for given centres, by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G are the kernel and the tail at the centres. If every site is a centre, this is the smoothing spline;
// otherwise it is the regression spline on a subset of its basis, which approaches it with more centres.
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

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/correction/sites.h"
#include "models/model/correction.h"

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

// The limit of the number of sites; more would take over 4 GiB and minutes.
inline constexpr Eigen::Index kMostDirectSites = 20000;

// With every site as a centre: the projected system (projected_kernel.h) is solved by a Cholesky factorisation. The
// paper inverts the saddle matrix of eq. 4 by truncated singular values, which takes a hundred times as long and has
// the same purpose (models/fit/open_choices.h). With smoothing 0 the function interpolates as closely as the smallest
// smoothing allows at which the matrix can be factorised. Errors: too many sites; no factorisation; interrupted,
// checked before each step. Deterministic on one machine. O(N^3), N^2 doubles. Source: Hoever & Harders (2009), eqs.
// 2-8.
Result<SolvedWeights> solve_direct(const Sites& sites, const FitControl& control = {});

}  // namespace palpate
