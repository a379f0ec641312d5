// Weights and tail for given centres, by weighted least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2
// through the singular value decomposition of the matrix with its columns
// scaled to length 1; singular values below 1e-12 times the largest are
// dropped, so that the shortest solution is taken where the data do not decide
// (more centres than sites, coinciding centres, a constant feature).
//
// The N rows are folded into a small triangle block by block (QR), then the
// triangle is decomposed: the accuracy of an SVD of the whole matrix at the
// cost of a QR, memory O(columns^2 + block) whatever N is.
//
// Where unknowns outnumber what the sites can tell (clusters of sites, noise),
// least squares turns noise into weights without bound, and the values between
// the sites with them. So there is a ridge, lambda |y|^2, y the unknowns of
// the scaled columns, with the lambda that makes the data most probable when
// noise and unknowns are normal: with singular values s_i and z = U^T S f it
// minimises
//   N ln(sum_i lambda z_i^2 / (s_i^2 + lambda) + rho^2) + sum_i ln(1 + s_i^2 / lambda).
// It is taken where sites are fewer than ten to an unknown, or where it says that
// noise rules (lambda above 1e-6 s_1^2); a healthy fit stays plain least squares.
// Sites that come with a smoothing of their own get that penalty instead
// (penalised_weights.h).
// Source: Hoever & Harders (2009), eq. 8 and section 4.2.1; MacKay (1992),
// "Bayesian interpolation", for the evidence.
#pragma once

#include <optional>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

namespace palpate {

// What is left of the sites once their rows are folded: all that weights need.
struct FoldedRows {
  // As many rows as columns, with the lengths and angles of row_scale * (Phi G f),
  // n + tail + 1 columns: the kernel at the n centres, the tail and the data. The
  // last row is 0 but for its last value. R of the QR factorisation, for one.
  Eigen::MatrixXd triangle;
  Eigen::Index sites = 0;
  Eigen::Index rows = 0;            // the sites that count for something
  std::optional<double> smoothing;  // of the sites
  double strength = 1.0;
};

// Block after block of each half of the rows, then both. False if cancelled. `sites` and `centres` must fit together.
bool fold_rows(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres, const FitControl& control,
               FoldedRows& folded);
// Those of validate_sites; centres that are not points as the sites are.
Status validate_centres(const Sites& sites, const Eigen::MatrixXd& centres);

// solve_weights without its first step.
Result<FittedRbf> solve_folded(const FoldedRows& folded, KernelKind kernel, const Eigen::MatrixXd& centres);

// `centres`: d x n, any points, n may be 0. Errors: those of validate_sites; a
// wrong centre size; the decomposition did not converge; interrupted.
// Deterministic; uses two threads. Off the tick.
Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres,
                                const FitControl& control = {});

}  // namespace palpate
