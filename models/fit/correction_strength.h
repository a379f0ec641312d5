// Selects strength, smoothing and reach of the correction by cross-validation.
//
// A correction h of the residual of the trend helps only as far as other strokes have the same residual. For each fold
// (models/training/cross_validation.h), h is fitted to the rows of the others, by penalised least squares on up to 200
// random centres,
//   minimise sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,
// where r is the residual of a trend fitted to the same rows. The rows of the fold are then predicted by
//   f = max(lowest, T(x) + g(x) clamp(strength h(x), -limit, limit))
// with g the trust around the rows of the other folds. The strength (0, none, to 1) is that of the combination with
// the lowest mean score. The common rule (models/training/cross_validation.h) then selects smoothing and inner radius
// of the trust at this strength. No correction is its simplest candidate, followed by the smallest radius with the most
// smoothing. The smoothing is the ratio of noise variance to prior variance and does not depend on the number of
// centres, so one value serves every method, and with more centres each approaches the smoothing spline through all
// sites.
// Sources: Wahba (1990) (smoothing splines; regression splines as subsets of the basis); Craven & Wahba (1979); Hastie,
// Tibshirani & Friedman (2009), 7.10.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/model/fitted_model.h"
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

  int folds() const { return static_cast<int>(trend_N.cols()); }
  // The indices of the rows of the other folds.
  std::vector<Eigen::Index> outside(int without) const;
  // The residual of the trend without that fold. Where no force is measured, a trend below 0 needs no correction.
  Eigen::VectorXd residual_N(int without) const;
  // The force at row `i` without its fold, as FittedModel computes it. `trust`: g; `h`: strength times correction, N.
  double predicted_N(const ModelData& common, std::size_t i, double trust, double h) const;
};

struct StrengthChoice {
  double smoothing = 0.0;
  double strength = 1.0;
  double inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score), without the correction
  double error_over_jnd = 0.0;        // the same, with the correction
};

// The trust g at a distance: 1 up to the inner radius, 0 from the outer one, a cubic step between.
double trust_at_distance(double distance, double inner_radius, double outer_radius);
// Sets `distance` of the rows.
void find_distances(CrossValidationRows& rows);

// The rows of the regression of the trend, at most 5000 of them. `common`: with the normalisation. `row_features`:
// features x rows, SI. `left_out_trends`: columns x folds, the weights of the trends fitted without each fold.
CrossValidationRows cross_validation_rows(const ModelData& common, const TrendRows& rows,
                                          const Eigen::MatrixXd& row_features, const Eigen::MatrixXd& left_out_trends);

// `common`: with the JND, the limits of correction and force, and a cover whose inner radius is the smallest candidate,
// with every site inside.
StrengthChoice choose_strength(const CrossValidationRows& rows, const ModelData& common);

}  // namespace palpate
