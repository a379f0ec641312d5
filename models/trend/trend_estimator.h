// The non-negative regression of the trend: its columns, the weights s_i of its rows and its equation are in
// models/METHOD.md, Trend. The elastic response is a P-spline (Eilers & Marx 1996). alpha is the relative error of all
// other columns, of which repeated measurements agree to about a tenth (errors in variables; Golub & Van Loan 1980);
// columns that the recording cannot separate then share their effect. Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/model/fitted_model.h"
#include "models/samples/samples.h"
#include "models/samples/selection.h"

namespace palpate {

// The number of basis functions of depth for each branch, stop and creeping bristle.
inline constexpr std::size_t kCurveTerms = 3;

bool has_kind(const std::vector<FeatureSpec>& features, FeatureKind kind);
// The constants of the parts of a feature: relaxation times in s, or thresholds in m (stops).
std::vector<double> constants_of(const FeatureSpec& spec);
// The relaxation times of all low-passes and Maxwell branches, in order.
std::vector<double> relaxation_times_s(const std::vector<FeatureSpec>& features);

// The candidate features of a trend; a regression gives their parts the drive curves.
struct FeatureList {
  // Sorted by kind: depth, velocity, maxwell_spectrum (any number), stops, creep.
  std::vector<FeatureSpec> features{FeatureSpec{}};

  // Adds a feature in the order of kinds. `constants`: as constants_of; none for velocity. Without parts adds nothing.
  void add(FeatureKind kind, const std::vector<double>& constants = {});
  bool operator==(const FeatureList&) const = default;
};

// The dictionary: all terms that a recording of this length and rate can identify: viscosity, Maxwell branches in three
// bands (fast, middle, slow), of which each sum is one feature, up to 8 stops, whose thresholds halve from half of the
// greatest depth down to the encoder step, and creeping bristles. The regression sets the weights of useless ones to 0.
FeatureList dictionary(const Samples& samples);
// Its relaxation times in s, ascending.
std::vector<double> dictionary_times_s(const Samples& samples);
// A list with one feature for each relaxation time.
FeatureList single_times(bool velocity, const std::vector<double>& times_s);
// The name of a candidate feature in reports, with the range of its constants.
std::string term_name(const FeatureSpec& spec);
// The drive curve of a branch, or the friction curve of a stop or creeping bristle, from its kCurveTerms weights.
DriveCurve combined_curve(FeatureKind kind, const double* weights, double reference_depth_m);
using ColumnList = std::vector<Eigen::Index>;

// The design matrix of a trend's regression: a row for each of some samples in contact, a column for each basis
// function. Columns with memory are features that FeaturePlan computes, with a basis function as the drive curve.
class TrendColumns {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // At most `most_rows` evenly spaced samples in contact, of those at least `least_step_s` apart. `samples` outlives
  // this. Errors: interrupted.
  static Result<TrendColumns> make(const Samples& samples, FeatureList list, std::size_t most_rows,
                                   const FitControl& control = {}, double least_step_s = 0.0);

  const Samples& samples() const { return *samples_; }
  const FeatureList& list() const { return list_; }
  // The samples of the rows.
  const std::vector<std::size_t>& rows() const { return rows_; }
  std::size_t count() const { return rows_.size(); }
  // Row i is sample stride() * i of those in contact that are far enough apart.
  std::size_t stride() const { return stride_; }
  double force_N(std::size_t row) const { return samples_->rows[rows_[row]].force_N; }
  double depth_m(std::size_t row) const { return samples_->rows[rows_[row]].motion.position_m; }
  // The division of the rows for cross-validation: the folds of the samples or, after leave_out_units(), their units.
  int fold(std::size_t row) const { return by_unit_ ? unit(row) % folds() : samples_->fold[rows_[row]]; }
  int folds() const { return by_unit_ ? std::min(samples_->units, kMostUnitFolds) : samples_->folds; }
  int unit(std::size_t row) const { return samples_->unit[rows_[row]]; }
  void leave_out_units() { by_unit_ = true; }

  const Matrix& terms() const { return terms_; }
  Eigen::Index columns() const { return terms_.cols(); }
  // The columns of each feature of the list.
  const std::vector<ColumnList>& feature_columns() const { return feature_columns_; }
  // The columns of those features of the list for whose index `wanted` is true.
  template <typename Wanted>
  ColumnList columns_of(const Wanted& wanted) const {
    ColumnList columns;
    for (std::size_t f = 0; f < feature_columns_.size(); ++f)
      if (wanted(f)) columns.insert(columns.end(), feature_columns_[f].begin(), feature_columns_[f].end());
    return columns;
  }

 private:
  static constexpr int kMostUnitFolds = 6;

  const Samples* samples_ = nullptr;
  bool by_unit_ = false;
  FeatureList list_;
  std::size_t stride_ = 1;
  std::vector<std::size_t> rows_;
  std::vector<ColumnList> feature_columns_;
  Matrix terms_;
};

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> features;
};
// The trend and features for the weights `x` of the regression. `all`: keep features whose weights are 0.
FittedTrend fitted_trend(const TrendColumns& columns, const Eigen::VectorXd& x, bool all);

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
