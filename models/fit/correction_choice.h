// Selects whether a model has a correction, its smoothing and its reach, by cross-validation.
//
// A correction h of the residual of the trend helps only as far as other strokes have the same residual. For each fold
// (models/samples/cross_validation.h), h is fitted to the rows of the others, by penalised least squares on up to 200
// random centres,
//   minimise sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,
// where r is the residual of a trend fitted to the same rows. The rows of the fold are then predicted by
//   f = max(lowest, T(x) + g(x) clamp(h(x), -limit, limit))
// with g the trust around the rows of the other folds. The lowest score chooses smoothing and inner radius of the
// trust; no correction is one of the candidates. One
// smoothing serves every method: with more centres each approaches the smoothing spline through all sites.
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
