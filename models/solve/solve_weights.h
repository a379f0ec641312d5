// Weights and tail for given centres, by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G are the kernel and the tail at the centres; h is then multiplied by the sites' strength. If every site is
// a centre, this is the smoothing spline of fit_direct.h, otherwise the regression spline on a subset of its basis,
// which approaches it with more centres.
//
// The smoothing is that of the sites, or otherwise the most likely one (projected_kernel.h): plain least squares is
// ill-posed where the sites (clusters, noise) do not determine the unknowns, and the values between the sites then
// have no bound. With ten sites to an unknown and no selected smoothing there is neither penalty nor side condition; a
// ridge of 1e-6 of the columns' length separates duplicate centres.
//
// A QR factorisation reduces the N rows block by block to a small triangle, to which the penalty is added: the accuracy
// of a QR factorisation of the whole matrix, with memory O(columns^2 + block) for any N.
// Sources: Hoever & Harders (2009), eq. 8 and section 4.2.1; Wahba (1990), sections 1.3 and 7.2.
// Thread guarantee: slow side, pure. The sites must pass validate_sites.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/training/sites.h"

namespace palpate {

// Diagnostics of a fit.
struct FitReport {
  Eigen::Index centres_used = 0;
  // Condition number of the solved system: of the columns scaled to length 1, or of the smoothed matrix (direct).
  double condition = 0.0;
  // sqrt(mean(row_scale^2 (f - h)^2)) over the sites.
  double residual_rms = 0.0;
  // The factor of the penalty.
  double smoothing = 0.0;
  // Sentences for the user: what was clamped, truncated or skipped.
  std::vector<std::string> notes;
};

struct FittedRbf {
  RbfFunction function;
  FitReport report;
};

// The rows of the sites after a QR factorisation, sufficient to compute the weights.
struct FactorisedRows {
  // The R factor of row_scale * (G Phi f), tail + n + 1 columns: the tail, the kernel at the n centres and the data.
  // Square; the last row is 0 except for its last value.
  Eigen::MatrixXd triangle;
  Eigen::Index sites = 0;
  Eigen::Index plain_unknowns_limit = 0;  // largest number of unknowns for plain least squares
  double smoothing = 0.0;
  double strength = 1.0;
  bool as_2009 = false;  // weights by truncated singular values
};

// Factorises the rows. `centres`: d x n, any points, n may be 0. Errors: those of choose_smoothing. Deterministic; uses
// two threads.
Result<FactorisedRows> factorise_rows(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres);

// The weights from the factorised rows.
FittedRbf penalised_weights(const FactorisedRows& factorised, KernelKind kernel, const Eigen::MatrixXd& centres);
// Both steps. Errors: those of factorise_rows.
Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres);

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

}  // namespace palpate
