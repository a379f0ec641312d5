// Fits the trend (models/model/trend.h) to its regression rows.
//
//   minimise sum_i s_i^2 (f_i - T_i)^2,  all coefficients >= 0
//
// s_i = 1 / JND(f_i), or as the weighting says. Contact is one-sided: a sample
// without measured force says only that the force is not positive, so it counts
// only while the trend is above it (active set). Coefficients of Bernstein
// bases that are not negative make E rise and every viscosity and stiffness not
// negative; on real recordings that is worth more than any ridge.
// Source of the solver: Lawson & Hanson (1974), chapter 23, on the normal
// equations; columns are scaled to unit norm first.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/model/trend.h"
#include "models/training/trend_rows.h"
#include "models/training/weighting.h"

namespace palpate {

// x >= 0 that minimises x^T G x - 2 b^T x. `gram`: n x n, symmetric, positive
// semidefinite; a small ridge keeps equal columns apart. `start`: a solution to
// begin at, n values >= 0, or empty. Returns n values.
Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start = {});

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> branches;  // one maxwell_branch per relaxation time
  std::vector<FeaturePart> stops;     // one per threshold; without those that carry nothing
  double weighted_rms = 0.0;          // of s_i (f_i - T_i), over the active rows
  std::vector<char> active;           // per row: counted in the last pass
};

// What drives the branches: the rate g'(d) v of an elastic response that the fit
// finds, or, as in eq. 1 of the paper, the velocity alone (g' constant). The
// comparison of choices (palpate-bench) says what the first is worth.
enum class BranchDrive { elastic_rate, velocity };

// `robust`: rows are scaled down as weighting.h has it, again after every pass.
// `force_noise_floor_N`: at or below it a sample counts as "no measured force".
FittedTrend fit_trend(const TrendRows& rows, Weighting weighting, const JndLine& jnd, double force_noise_floor_N,
                      BranchDrive drive = BranchDrive::elastic_rate, bool robust = false);

}  // namespace palpate
