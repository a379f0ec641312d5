// The trend's one regression (models/model/trend.h): rows in, weights out.
//
//   minimise sum_i s_i^2 (f_i - sum_j c_j t_ij)^2 + lambda sum_j g_jj c_j^2
//            + mu g_e sum_k (c_k+1 - c_k)^2,   all c_j >= 0,   g_jj = sum_i s_i^2 t_ij^2
//
// s_i = 1 / JND(f_i), or as the weighting says, scaled down where the error is large
// (weighting.h). Contact is one-sided: a sample without measured force says only that
// there is none, so it counts only while the trend is above it (active set). Weights
// that are not negative make E rise and every viscosity, stiffness and friction not
// negative; on recorded data that is worth more than any other choice.
//
// lambda, of all but the elastic response, is the variance of a part's own error over the
// square of the part: a material repeats what each of its parts does to a tenth or so, and
// the expected square of such errors is the penalty (errors in variables; Golub & Van Loan
// 1980). So parts that the recording cannot tell apart share what they explain. mu keeps
// the coefficients c_k of the elastic response near their neighbours' (g_e: the mean of its
// g); it is the largest of kSmoothness that the folds left out allow (acceptance.h).
//
// One Gram matrix for each fold serves every subset of the columns and every fold left
// out. Source of the solver: Lawson & Hanson (1974), chapter 23, on the normal
// equations; columns are scaled to unit norm first.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/training/trend_rows.h"
#include "models/training/weighting.h"

namespace palpate {

// x >= 0 that minimises x^T G x - 2 b^T x. `gram`: n x n, symmetric, positive
// semidefinite; a small ridge keeps equal columns apart. `start`: a solution to
// begin at, n values >= 0, or empty. Returns n values.
Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start = {});

using ColumnList = std::vector<Eigen::Index>;

// Of a part; lambda is its square. Of a list of few parts that somebody asked for each stands
// for itself, and has less to share; a penalty as large as the dictionary's leaves too little
// damping in them to come to rest (tests/accuracy/closed_loop_test.cpp).
inline constexpr double kOwnError = 0.1;
inline constexpr double kOwnErrorOfFew = 0.03;
inline constexpr std::array kSmoothness{1e-2, 1e-3, 1e-4};

// What a set of columns predicts of every fold without it.
struct LeftOutTrend {
  std::vector<double> fold_error;  // sums of squared errors over the JND, by fold
  double count = 0.0;              // rows behind them
  Eigen::MatrixXd solutions;       // one column a fold: the weights without it; 0 where not asked for

  double rms() const;
};

class TrendRegression {
 public:
  // `force_noise_floor_N`: at or below it a sample counts as "no measured force".
  TrendRegression(const TrendRows& rows, int folds, Weighting weighting, const JndLine& jnd,
                  double force_noise_floor_N);

  // `columns`: ascending. `near`: of a set much like it, or nothing.
  LeftOutTrend left_out(const ColumnList& columns, const LeftOutTrend* near = nullptr) const;
  // The weights from all rows, over all columns.
  Eigen::VectorXd solve(const ColumnList& columns) const;
  ColumnList all_columns() const;

 private:
  struct Equations {
    Eigen::MatrixXd gram;
    Eigen::VectorXd right_side;
    double squares = 0.0;
    double count = 0.0;
    double residual(const Eigen::VectorXd& x) const;
  };
  Eigen::VectorXd weights(Eigen::MatrixXd gram, const Eigen::VectorXd& right_side, const ColumnList& columns,
                          double smoothness, const Eigen::VectorXd& start) const;
  LeftOutTrend left_out(const ColumnList& columns, double smoothness, const LeftOutTrend* near) const;
  void gather(const TrendRows& rows, const std::vector<double>& elsewhere_m);

  std::vector<double> scale_;
  std::vector<Equations> train_;       // by fold: its own rows
  std::vector<Equations> validation_;  // by fold: those of its rows that count when it is left out
  Equations total_;
  double smoothness_ = kSmoothness[1];
  double own_error_;
};

}  // namespace palpate
