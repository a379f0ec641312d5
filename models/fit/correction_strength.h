// Selects strength, smoothing and reach of the correction by cross-validation.
//
// A correction h of the residual of the trend helps only as far as other strokes have the same residual. For each fold
// (models/training/fold_assignment.h), h is fitted to the rows of the others, by penalised least squares on up to 200
// random centres,
//   minimise sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,
// where r is the residual of a trend fitted to the same rows. The rows of the fold are then predicted by
//   f = max(lowest, T(x) + g(x) clamp(strength h(x), -limit, limit))
// with g the trust around the rows of the other folds. The strength (0, none, to 1) is that of the combination with
// the lowest mean score. The common rule (models/training/selection.h) then selects smoothing and inner radius of the
// trust at this strength. No correction is its simplest candidate, followed by the smallest radius with the most
// smoothing. The smoothing is the ratio of noise variance to prior variance and does not depend on the number of
// centres, so one value serves every method, and with more centres each approaches the smoothing spline through all
// sites.
// Sources: Wahba (1990) (smoothing splines; regression splines as subsets of the basis); Craven & Wahba (1979); Hastie,
// Tibshirani & Friedman (2009), 7.10.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

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
};

struct StrengthInput {
  const CrossValidationRows& rows;
  int folds = 0;
  KernelKind kernel = KernelKind::cubic;
  JndLine jnd;
  double correction_limit_N = 0.0;
  double lowest_force_N = 0.0;  // lower limit of the force of the model
  double least_radius = 0.0;    // smallest inner radius, with every site inside
  double outer_to_inner = 3.0;  // ratio of the outer to the inner radius
};

// The prediction of one row by a model fitted without its fold.
struct CrossValidationPrediction {
  double error_N = 0.0;  // absolute error of the force
  double measured_N = 0.0;
  double predicted_N = 0.0;
  double distance = 0.0;  // to the nearest row of another fold
};

struct StrengthChoice {
  double smoothing = 0.0;
  double strength = 1.0;
  double inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score), without the correction
  double error_over_jnd = 0.0;        // the same, with the correction
};

// The force at row `i` without its fold, as FittedModel computes it. `trust`: g; `h`: strength times correction, N.
double cross_validated_force_N(const StrengthInput& input, std::size_t i, double trust, double h);
// The trust g at a distance: 1 up to the inner radius, 0 from the outer one, a cubic step between.
double trust_at_distance(double distance, double inner_radius, double outer_radius);
// Sets `distance` of the rows.
void find_distances(CrossValidationRows& rows, int folds);

StrengthChoice choose_strength(const StrengthInput& input);

}  // namespace palpate
