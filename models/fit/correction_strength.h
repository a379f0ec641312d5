// How strong the correction of a model may be, from strokes left out.
//
// A correction h fitted to what the trend leaves over is of use only as far as the
// next stroke has the same rest. Whole folds (models/training/fold_dealer.h) are
// left out in turn, of the trend too, h is fitted to the other rows by penalised least squares,
//   minimise sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,
// on a few hundred random centres, and the rows left out are predicted by
//   f = max(lowest, T(x) + g(x) clamp(strength h(x), -limit, limit))
// with g the trust of the domain guard around the rows that were kept. Smoothing, strength
// (from 0, none, to 1, all) and the radius of the guard are selected together by the
// common rule (models/training/selection.h), no correction being the simplest candidate, then
// the shortest radius and with it the most smoothing. The smoothing is the variance of the noise over that of the prior
// and does not depend on the number of centres: one choice serves every method, and with more centres each method comes
// closer to the smoothing spline through all the sites instead of following the noise. Sources: Wahba (1990) (smoothing
// splines; regression splines as subsets of the basis); Craven & Wahba (1979); Hastie, Tibshirani & Friedman
// (2009), 7.10. Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

namespace palpate {

// Rows in contact, by fold in ascending order, each to be predicted when its fold is left out.
struct LeftOutRows {
  Eigen::MatrixXd points;   // normalised features, one column a row
  Eigen::VectorXd force_N;  // measured
  Eigen::VectorXd depth_m;
  Eigen::VectorXd row_scale;  // what an error counts
  Eigen::MatrixXd trend_N;    // of every row, by the trend without fold k in column k
  std::vector<int> fold;
  std::vector<char> no_force;    // nothing was measured: the force is not positive
  std::vector<double> distance;  // to the nearest row of another fold; infinite without one
};

struct StrengthInput {
  const LeftOutRows& rows;
  int folds = 0;
  KernelKind kernel = KernelKind::cubic;
  JndLine jnd;
  double correction_limit_N = 0.0;
  double lowest_force_N = 0.0;  // of the model
  double least_radius = 0.0;    // of the guard, so that every site is inside
  double outer_to_inner = 3.0;
};

// One row predicted without its fold.
struct LeftOutPrediction {
  double error_N = 0.0;  // of the force, absolute
  double measured_N = 0.0;
  double predicted_N = 0.0;
  double distance = 0.0;  // to the nearest row of another fold
};

struct StrengthChoice {
  double smoothing = 0.0;
  double strength = 1.0;
  double inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::typical), without and with the correction
  double error_over_jnd = 0.0;
};

// The force at row `i` without its fold, as FittedModel computes it; `h`: the correction there.
double left_out_force_N(const StrengthInput& input, std::size_t i, double trust, double h);
// Trust of the guard at this distance.
double trust_at_distance(double distance, double inner_radius, double outer_radius);
// `distance` of the rows, from all the rest.
void find_distances(LeftOutRows& rows, int folds);

StrengthChoice choose_strength(const StrengthInput& input);

}  // namespace palpate
