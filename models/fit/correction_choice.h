// Selects by cross-validation whether a model has a correction, how smooth it is, and how far from the data it is
// trusted. A correction h of the residual of the trend helps only as far as other strokes have the same residual.
//
// Candidates: no correction; or a smoothing of 1e-9 to 10 (in units of the mean eigenvalue of the kernel) with an inner
// radius of 1, 2, 4 or 8 times the smallest. Each predicts the rows of a fold (models/samples/cross_validation.h) from
// those of the others:
//   1. h minimises sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,  on up to 200 random centres;
//      r is the residual of the trend that was fitted to the same rows.
//   2. f = max(lowest, T(x) + g(x) clamp(h(x), -limit, limit)), g the trust around the rows of the other folds.
// The lowest score wins. One smoothing serves every method: with more centres each approaches the smoothing spline
// through all sites.
// Sources: Wahba (1990) (smoothing splines; regression splines as subsets of the basis); Craven & Wahba (1979); Hastie,
// Tibshirani & Friedman (2009), 7.10.
// Thread guarantee: slow side, pure.
#pragma once

#include "models/fit/residual_rows.h"

namespace palpate {

struct CorrectionChoice {
  bool used = false;
  double smoothing = 0.0;
  double inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score), without the correction
  double error_over_jnd = 0.0;        // the same, with the correction
};

// `common`: needs the JND, the limits of correction and force, and a cover with every site inside, whose inner radius
// is the smallest candidate.
CorrectionChoice choose_correction(const ResidualRows& rows, const ModelData& common);

}  // namespace palpate
