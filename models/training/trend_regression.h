// The trend's one regression (models/model/trend.h): rows in, weights out.
//
//   minimise sum_i s_i^2 (f_i - sum_j c_j t_ij)^2 + alpha^2 sum_j g_jj c_j^2
//            + lambda S n sum_k (c_k+1 - c_k)^2,       all c_j >= 0,
//   g_jj = sum_i s_i^2 t_ij^2,  S = sum_i s_i^2,  n = kElasticPieces
//
// s_i = 1 / JND(f_i), or as the weighting says, times the weight of a Cauchy likelihood where the
// error is large (weighting.h). Contact is one-sided: a sample without measured force counts
// only while the trend is above it (active set). Both are iterated within the rows of each fit,
// so that rows that are left out have no influence on them. Weights that are not negative make the
// elastic response rise, and every viscosity, stiffness and friction dissipate.
//
// lambda: the elastic response is a P-spline, whose penalty approximates the integral of its squared
// second derivative (Eilers & Marx 1996; elastic_spline.h). lambda is selected by cross-validation
// and the common rule (selection.h).
// alpha, of all other parts, is their relative error: a material repeats what each of its parts
// does to about a tenth, and the expected square of such errors is the penalty (errors in variables;
// Golub & Van Loan 1980). Parts that the recording cannot separate share what they explain.
//
// Source of the solver: Lawson & Hanson (1974), chapter 23, on the normal equations; columns are
// scaled to unit norm first.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/training/selection.h"
#include "models/training/trend_rows.h"
#include "models/training/weighting.h"

namespace palpate {

// x >= 0 that minimises x^T G x - 2 b^T x. `gram`: n x n, symmetric, positive
// semidefinite; a small ridge keeps equal columns apart. `start`: a solution to
// begin at, n values >= 0, or empty. Returns n values.
Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start = {});

using ColumnList = std::vector<Eigen::Index>;

// alpha. A short list of parts that a user asked for has less to share, and a large penalty leaves
// it too little damping to come to rest (tests/accuracy/closed_loop_test.cpp).
inline constexpr double kPartError = 0.1;
inline constexpr double kPartErrorOfFew = 0.03;

// What a regression needs besides its rows.
struct TrendProblem {
  double reference_depth_m = 0.0;
  double rms_velocity_m_per_s = 0.0;
  double force_noise_floor_N = 0.0;  // at or below it a sample has no measured force
  Weighting weighting = Weighting::jnd;
  JndLine jnd{};
};

struct CrossValidated {
  FoldErrors errors;
  Eigen::MatrixXd solutions;  // one column a fold: the weights without it; 0 for columns not asked for
};

class TrendRegression {
 public:
  enum class Smoothness { selected, fixed };

  // `folds`: of the rows, at least 1. Selects lambda with all columns, or fixes it where many regressions are compared.
  TrendRegression(const TrendRows& rows, int folds, const TrendProblem& problem,
                  Smoothness smoothness = Smoothness::selected);

  // `columns`: ascending. Rows deeper than any of the other folds are predicted by nobody's data
  // and do not count.
  CrossValidated cross_validate(const ColumnList& columns) const { return cross_validate(columns, smoothness_); }
  // The weights from all rows, over all columns.
  Eigen::VectorXd solve(const ColumnList& columns) const;
  ColumnList all_columns() const;
  double smoothness() const { return smoothness_; }

 private:
  // The normal equations of all rows but those of one fold.
  struct Equations {
    Eigen::MatrixXd gram;
    Eigen::VectorXd right_side;
    double scale_squares = 0.0;     // S
    Eigen::VectorXd near_solution;  // with all columns, to start at
  };
  Equations gather(int left_out) const;
  Equations sum(int left_out, const std::vector<double>& scale) const;
  Eigen::VectorXd weights(const Equations& equations, const ColumnList& columns, double smoothness) const;
  CrossValidated cross_validate(const ColumnList& columns, double smoothness) const;

  const TrendRows& rows_;
  const TrendProblem& problem_;
  double part_error_;
  double smoothness_;
  std::vector<Equations> folds_;  // by fold left out
  Equations all_;
};

}  // namespace palpate
