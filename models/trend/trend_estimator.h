// The non-negative regression of the trend (models/model/trend.h).
//
//   minimise sum_i s_i^2 (f_i - sum_j c_j t_ij)^2 + alpha^2 sum_j g_jj c_j^2
//            + lambda S n sum_k (c_k+1 - c_k)^2,       all c_j >= 0,
//   g_jj = sum_i s_i^2 t_ij^2,  S = sum_i s_i^2,  n = kElasticPieces
//
// t_ij: term j at row i (trend_columns.h), f_i: force, k: index of an elastic term. s_i = 1 / JND(f_i), or by the
// chosen weighting, times the weight of a Cauchy likelihood (weighting.h). Contact is one-sided: a sample without
// measured force counts only while the trend there is positive (active set). Both are iterated within the training rows
// of each fold, so that the fold itself has no influence on them. Non-negative weights make the elastic response rise
// and every viscosity, branch and friction dissipate.
//
// The elastic response is a P-spline, whose penalty approximates the integral of its squared second derivative (Eilers
// & Marx 1996; models/model/trend.h). lambda is selected by cross-validation (cross_validation.h). alpha is the
// relative error of all other columns, of which repeated measurements agree to about a tenth; the penalty is the
// expected square of such errors (errors in variables; Golub & Van Loan 1980). Columns that the recording cannot
// separate then share their effect.
//
// Source of the solver: Lawson & Hanson (1974), chapter 23, on the normal equations with columns scaled to unit norm.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/samples/cross_validation.h"
#include "models/samples/weighting.h"
#include "models/trend/trend_columns.h"

namespace palpate {

// alpha. The second value is for models without creep, which have few features: 0.1 leaves their trend too little
// damping to come to rest (tests/accuracy/closed_loop_test.cpp).
inline constexpr double kPartError = 0.1;
inline constexpr double kPartErrorOfFew = 0.03;

struct CrossValidated {
  FoldErrors errors;
  Eigen::MatrixXd solutions;  // columns x folds: the weights from the other folds; 0 outside `columns`
};

// How errors of the force count.
struct TrendWeights {
  JndLine jnd{};
  Weighting weighting = Weighting::jnd;
};

class TrendEstimator {
 public:
  enum class Smoothness { selected, fixed };

  // `fixed`: lambda is 1e-8, for comparisons of many regressions.
  TrendEstimator(const TrendColumns& columns, const TrendWeights& weights,
                 Smoothness smoothness = Smoothness::selected);

  // Errors of the trend with these columns (ascending). Rows deeper than all rows of the other folds do not count:
  // they would be extrapolated.
  CrossValidated cross_validate(const ColumnList& columns) const { return cross_validate(columns, smoothness_); }
  // The weights fitted to all rows, one for each column of the rows; 0 outside `columns`.
  Eigen::VectorXd fit(const ColumnList& columns) const { return solve(equations_.back(), columns, smoothness_); }
  ColumnList all_columns() const {
    return columns_.columns_of([](std::size_t) { return true; });
  }

 private:
  // The normal equations of the rows outside one fold.
  struct Equations {
    Eigen::MatrixXd gram;
    Eigen::VectorXd right_side;
    double scale_squares = 0.0;  // S
    Eigen::VectorXd start;       // the solution with all columns, an initial value
  };
  Equations gather(int left_out) const;
  Equations sum(const std::vector<double>& scale) const;
  Eigen::VectorXd solve(const Equations& equations, const ColumnList& columns, double smoothness) const;
  CrossValidated cross_validate(const ColumnList& columns, double smoothness) const;

  const TrendColumns& columns_;
  TrendWeights weights_;
  double part_error_;
  double smoothness_;
  std::vector<double> deepest_elsewhere_m_;  // by fold
  std::vector<Equations> equations_;         // index: the fold that is left out; the last of all rows
};

}  // namespace palpate
