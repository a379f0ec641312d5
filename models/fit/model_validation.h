// Cross-validation of trend and correction together. It selects whether the correction is used, its smoothing and its
// reach, and calibrates the error bound of the model.
//
// A correction h of the residual of the trend helps only as far as other strokes have the same residual. For each fold
// (models/training/cross_validation.h), h is fitted to the rows of the others, by penalised least squares on up to 200
// random centres,
//   minimise sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,
// where r is the residual of a trend fitted to the same rows. The rows of the fold are then predicted by
//   f = max(lowest, T(x) + g(x) clamp(h(x), -limit, limit))
// with g the trust around the rows of the other folds. The selection rule chooses smoothing and inner radius of the
// trust. Its simplest candidate is no correction, followed by the smallest radius with the most smoothing. The
// smoothing is the ratio of noise variance to prior variance and does not depend on the number of centres. One value
// thus serves every method, and with more centres each approaches the smoothing spline through all sites.
// Sources: Wahba (1990) (smoothing splines; regression splines as subsets of the basis); Craven & Wahba (1979); Hastie,
// Tibshirani & Friedman (2009), 7.10.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "models/model/fitted_model.h"
#include "models/training/sites.h"
#include "models/training/trend_rows.h"

namespace palpate {

// Rows in contact in ascending order of their folds; each is predicted from the other folds.
struct CrossValidationRows {
  Eigen::MatrixXd points;   // normalised features, one column a row
  Eigen::VectorXd force_N;  // measured
  Eigen::VectorXd depth_m;
  Eigen::VectorXd row_scale;  // factor of the residual
  Eigen::MatrixXd trend_N;    // rows x folds: column k by the trend fitted without fold k
  std::vector<int> fold;
  std::vector<char> no_force;    // no measured force: the force is not positive
  std::vector<double> distance;  // to the nearest row of another fold; infinite if there is none
  std::size_t strokes = 0;       // of all recordings

  int folds() const { return static_cast<int>(trend_N.cols()); }
  // The indices of the rows of the other folds.
  std::vector<Eigen::Index> outside(int without) const;
  // The residual of the trend without that fold. Where no force is measured, a trend below 0 needs no correction.
  Eigen::VectorXd residual_N(int without) const;
  // The force at row `i` from the other folds, as FittedModel computes it but without the upper limit, with this inner
  // radius of the trust. `h`: the correction, N.
  double predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const;
};

// Sets `distance` of the rows.
void find_distances(CrossValidationRows& rows);

// The rows of the regression of the trend, at most 5000 of them. `common`: with the normalisation. `row_features`:
// features x rows, SI. `left_out_trends`: columns x folds, the weights of the trends fitted without each fold.
CrossValidationRows cross_validation_rows(const ModelData& common, const TrendRows& rows,
                                          const Eigen::MatrixXd& row_features, const Eigen::MatrixXd& left_out_trends);

struct CorrectionChoice {
  bool used = false;
  double smoothing = 0.0;
  double inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score), without the correction
  double error_over_jnd = 0.0;        // the same, with the correction
};
// `common`: needs the JND, the limits of correction and force, and a cover with every site inside, whose inner radius
// is the smallest candidate.
CorrectionChoice choose_correction(const CrossValidationRows& rows, const ModelData& common);

// The sites of a fit without a fold, at most 1500. The targets are the residuals of the trend without that fold.
Sites sites_without(const CrossValidationRows& rows, int fold, double smoothing);

// The prediction of one row by a model fitted without its fold.
struct CrossValidationPrediction {
  double error_N = 0.0;  // absolute error of the force
  double predicted_N = 0.0;
  double beyond = 0.0;  // distance to the nearest row of another fold, beyond the inner radius
};

// Calibrates the error bound of a model (models/model/fitted_model.h).
//
// The non-negative coefficients are fitted to the absolute errors by least squares, with rows scaled by 1 / JND. Then
// all are multiplied by the quantile of error over bound that gives a coverage of 97.5 % of the rows: more than 95 %,
// because a new recording differs more from the training than its strokes from each other. The floor is at least 10 mN
// (kForceFloor_N): without this minimum the coverage was 77 to 90 % on skin and 83 % on one trial of silicone, with it
// 97 to 100 %. The bound grows by at least a quarter of the largest force per unit of normalised distance. Empty with
// fewer than 50 predictions.
std::optional<ErrorBound> calibrate_bound(const std::vector<CrossValidationPrediction>& predictions, const JndLine& jnd,
                                          double largest_force_N);

// The error bound of a model; with fewer than three strokes it is at least 5 % of the force. `corrections`: fitted to
// `sites_without` each fold; empty: none, the errors are those of the trend.
std::optional<ErrorBound> bound_of(const CrossValidationRows& rows, const ModelData& common,
                                   const std::vector<CorrectionPtr>& corrections);

}  // namespace palpate
