// Weights and tail for given centres, by weighted least squares with a smoothing penalty (penalised_weights.h).
//
// The smoothing is that of the sites, or otherwise the most likely one (projected_kernel.h): plain least squares is
// ill-posed where the sites (clusters, noise) do not determine the unknowns, and the values between the sites then
// have no bound. With ten sites to an unknown and no selected smoothing, plain least squares is used.
//
// A QR factorisation reduces the N rows block by block to a small triangle, to which the penalty is added: the accuracy
// of a QR factorisation of the whole matrix, with memory O(columns^2 + block) for any N.
// Source: Hoever & Harders (2009), eq. 8 and section 4.2.1.
// Thread guarantee: slow side. The sites must pass validate_sites.
#pragma once

#include "engine/base/result.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

namespace palpate {

// The rows of the sites after a QR factorisation, sufficient to compute the weights.
struct FactorisedRows {
  // The R factor of row_scale * (Phi G f), n + tail + 1 columns: the kernel at the n centres, the tail and the data.
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

// The same with the weights of penalised_weights.
Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres);

}  // namespace palpate
