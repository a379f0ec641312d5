// How strong the correction of a model may be, from strokes left out.
//
// A correction h fitted to what the trend leaves over is of use only as far as the
// next stroke has the same rest. Whole folds (models/training/fold_dealer.h) are
// left out in turn, h is fitted to the other sites by penalised least squares,
//   minimise sum_i s_i^2 (r_i - h(x_i))^2 + smoothing w^T (sign Phi) w,  G^T w = 0,
// on a few hundred random centres, and the samples left out are predicted by
//   f = max(0, T(x) + strength g(x) clamp(h(x), -limit, limit))
// with g the trust of the domain guard around the sites that were kept. Smoothing,
// strength (from 0, none, to 1, all) and the radius of the guard are those of the
// least squared error over the JND; of several within one standard error of the
// differences between the folds, none at all, else the shortest radius and with it the
// most smoothing. The smoothing is the variance of the
// noise over that of the prior and does not depend on the number of centres: one
// choice serves every method, and with more centres each method comes closer to
// the smoothing spline through all the sites instead of following the noise.
// Sources: Wahba (1990) (smoothing splines; regression splines as subsets of the
// basis); Craven & Wahba (1979); Hastie, Tibshirani & Friedman (2009), 7.10.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

namespace palpate {

// A sample in contact, to be predicted when its fold is left out.
struct LeftOutSample {
  Eigen::VectorXd point;  // normalised features
  double trend_N = 0.0;
  double force_N = 0.0;
  double depth_m = 0.0;
  double velocity_m_per_s = 0.0;
  int fold = 0;
};

struct StrengthInput {
  const Sites& sites;  // group: the fold
  const std::vector<LeftOutSample>& samples;
  int folds = 0;
  KernelKind kernel = KernelKind::cubic;
  JndLine jnd;
  double correction_limit_N = 0.0;
  double least_radius = 0.0;  // of the guard, so that every site is inside
  double outer_to_inner = 3.0;
};

// One sample predicted without its fold.
struct LeftOutPrediction {
  std::size_t sample = 0;
  double error_N = 0.0;     // of the force, absolute
  double predicted_N = 0.0;
  double distance = 0.0;    // to the nearest site of another fold
};

struct StrengthChoice {
  double smoothing = 0.0;
  double strength = 1.0;
  double inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // RMS on the samples left out
  double error_over_jnd = 0.0;
  std::vector<double> fold_squares;   // sums of squared errors over the JND, by fold
  std::vector<LeftOutPrediction> predictions;
  std::vector<LeftOutPrediction> trend_predictions;  // the same by the trend alone
};

// Whether `a` predicts the same left-out samples better than `b`, by more than one
// standard error of the differences between the folds.
bool is_better(const StrengthChoice& a, const StrengthChoice& b);

StrengthChoice choose_strength(const StrengthInput& input);

}  // namespace palpate
