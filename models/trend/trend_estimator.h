// The non-negative regression of the trend (models/model/trend.h; models/METHOD.md, Trend).
//
//   minimise sum_i s_i^2 (f_i - sum_j c_j t_ij)^2 + alpha^2 sum_j g_jj c_j^2
//            + lambda S n sum_k (c_k+1 - c_k)^2,       all c_j >= 0,
//   g_jj = sum_i s_i^2 t_ij^2,  S = sum_i s_i^2,  n = kElasticPieces
//
// t_ij: term j at row i (trend_columns.h), f_i: force, k: index of an elastic term. s_i: 1 / JND(f_i) times the weight
// of a Cauchy likelihood; a sample without measured force counts only while the trend there is positive. Both are
// iterated within the training rows of each fold. The elastic response is a P-spline (Eilers & Marx 1996). alpha is the
// relative error of all other columns, of which repeated measurements agree to about a tenth (errors in variables;
// Golub & Van Loan 1980); columns that the recording cannot separate then share their effect. Thread guarantee: slow
// side, pure.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/samples/selection.h"
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

class TrendEstimator {
 public:
  // lambda, for comparisons of many regressions.
  static constexpr double kFirstSmoothness = 1e-8;

  // `smoothness`: lambda; 0: selected.
  TrendEstimator(const TrendColumns& columns, const JndLine& jnd, double smoothness = 0.0);

  // Errors of the trend with these columns (ascending). Rows deeper than all rows of the other folds do not count:
  // they would be extrapolated.
  CrossValidated cross_validate(const ColumnList& columns) const { return cross_validate(columns, smoothness_); }
  // The weights fitted to all rows, one for each column of the rows; 0 outside `columns`.
  Eigen::VectorXd fit(const ColumnList& columns) const;
  double smoothness() const { return smoothness_; }
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
  // Adds the rows, each times this change of its s_i^2.
  void add(Equations& equations, const std::vector<double>& squares) const;
  Eigen::VectorXd solve(const Equations& equations, const ColumnList& columns, double smoothness) const;
  CrossValidated cross_validate(const ColumnList& columns, double smoothness) const;

  const TrendColumns& columns_;
  JndLine jnd_;
  double part_error_, smoothness_;
  std::vector<double> deepest_elsewhere_m_;  // by fold
  // Index: the fold that is left out; of all rows as well where the smoothness is selected, for `fit`.
  std::vector<Equations> equations_;
};

// Below: the selection, by cross-validation and the selection rule, of the parameters of the memory that a linear
// regression cannot identify: how the relaxation times change with depth (`slowing`, engine/tick/features.h), and, for
// models with few features, one to three relaxation times.

// The gain of a term of the trend: the cross-validated error in JND (FoldErrors::rms_at_mean_score) with it and without
// it.
struct PartGain {
  std::string name;
  bool taken = false;
  double error_with = 0.0, error_without = 0.0;
};

// Returns `list` with the selected slowing of its branches, and appends its gain to `gains`. Errors: interrupted.
Result<FeatureList> select_slowing(const Samples& samples, const JndLine& jnd, const FeatureList& list,
                                   std::vector<PartGain>& gains, const FitControl& control);
// Selects `count` relaxation times from those of the dictionary (ascending, in s). Each candidate is a feature of one
// regression. Times are added one by one, by the lowest cross-validated error; after each addition, times move to
// neighbouring candidates while the error falls. `velocity`: whether the trend has viscosity. Errors: no candidates
// (recordings too short); interrupted.
Result<std::vector<double>> identify_relaxation(const Samples& samples, const JndLine& jnd, bool velocity,
                                                std::size_t count, const FitControl& control);

}  // namespace palpate
