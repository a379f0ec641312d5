// The trend's regression prepared for cross-validation: one Gram matrix of all
// candidate columns for every fold, so that any subset of the columns is fitted
// and evaluated without going back to the rows.
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/tick/jnd.h"
#include "models/training/trend_rows.h"
#include "models/training/weighting.h"

namespace palpate {

using ColumnList = std::vector<Eigen::Index>;

// The mean squared error over the JND of every fold when it is left out.
struct CrossValidation {
  std::vector<double> fold_error;
  std::vector<double> fold_count;
  std::vector<Eigen::VectorXd> solutions;  // per fold, over all columns, for a warm start

  double mean() const;  // over samples
  // Standard error of the mean difference to `other` between the folds.
  double standard_error_against(const CrossValidation& other) const;
};

class CrossValidatedTrend {
 public:
  // The rows' "stroke" is their fold, 0 to folds - 1.
  CrossValidatedTrend(const TrendRows& rows, int folds, Weighting weighting, const JndLine& jnd, double force_noise_floor_N);

  // `columns`: ascending. `near`: of a set much like it, or nothing.
  CrossValidation left_out(const ColumnList& columns, const CrossValidation* near = nullptr) const;
  // The solution on all folds, over all columns (0 where not asked for).
  Eigen::VectorXd solve(const ColumnList& columns) const;
  // Mean squared error over the JND of that solution on the data itself.
  double training_error(const Eigen::VectorXd& solution) const;

 private:
  struct Equations {
    Eigen::MatrixXd gram;
    Eigen::VectorXd right_side;
    double squares = 0.0;
    double count = 0.0;
    double residual(const Eigen::VectorXd& x) const;
  };
  void accumulate(const TrendRows& rows, const std::vector<double>& scale, const std::vector<char>& active,
                  const std::vector<double>& elsewhere_m);

  std::vector<Equations> train_;  // per fold: its own rows
  std::vector<Equations> validation_;  // per fold: those of its rows that count when it is left out
  Equations total_;
};

}  // namespace palpate
