// Weights and tail for given centres, by weighted least squares with a smoothing penalty
// (penalised_weights.h), the sites' own or, from few sites, the most likely one
// (choose_smoothing.h): where unknowns outnumber what the sites can tell (clusters of sites, noise),
// plain least squares turns noise into weights without bound, and the values between the sites with
// them. Ten sites to an unknown tell it by themselves.
//
// The N rows are folded into a small triangle block by block (QR), to which the penalty is
// added: the accuracy of a QR of the whole matrix, memory O(columns^2 + block) whatever N is.
// Source: Hoever & Harders (2009), eq. 8 and section 4.2.1.
#pragma once

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
  Eigen::Index told = 0;  // up to so many unknowns plain least squares
  double smoothing = 0.0;
  double strength = 1.0;
  bool as_2009 = false;  // weights by truncated singular values
};

// Block after block of each half of the rows, then both. `sites` and `centres` must fit together.
// Errors: those of choose_smoothing; interrupted.
Result<FoldedRows> fold_rows(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres,
                             const FitControl& control);
// Those of validate_sites; centres that are not points as the sites are.
Status validate_centres(const Sites& sites, const Eigen::MatrixXd& centres);

// `centres`: d x n, any points, n may be 0. Errors: those of validate_sites; a
// wrong centre size; those of choose_smoothing; interrupted.
// Deterministic; uses two threads. Off the tick.
Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres,
                                const FitControl& control = {});

}  // namespace palpate
