// The candidate features of a trend, the rows of its regression, and the trend made from the weights.
//
// A row holds the basis functions of the trend at one sample in contact, with u = depth / reference depth:
//   depth             int_0^u of the quadratic B-splines (models/model/trend.h): the elastic response
//   velocity          v B_k,2(min(u, 1)), k = 0..2, then the same with v / (1 + |v| / v_0): the viscosity
//   maxwell_spectrum  for each relaxation time a branch driven by int_0^u B_k,2, k = 0..2
//   stops             for each threshold r, s / r times 1 - (1 - u)^4, u and u^2
//   creep             for each time, q / r times the same; r is the greatest depth
// With a `surface`, branches follow the material's surface instead of the tool (engine/tick/features.h).
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/model/trend.h"
#include "models/training/motion_source.h"
#include "models/training/sites.h"

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
  // A surface_lag feature and the branches that determine the surface; empty: the surface does not lag.
  std::vector<FeatureSpec> surface{};

  // Adds a feature in the order of kinds. `constants`: as constants_of; none for velocity. Without parts adds nothing.
  void add(FeatureKind kind, const std::vector<double>& constants = {});
  bool operator==(const FeatureList&) const = default;
};

// The dictionary: all terms that a recording of this length and rate can identify. The non-negative regression sets the
// weights of terms that do not help to 0.
//   velocity    viscosity
//   relaxation  Maxwell branches, four relaxation times a decade, from two samples (at least 1 ms) to a third of the
//               recording (at most 100 s), in three bands (fast, middle, slow). The sum of a band is one feature.
//   stops       a Prandtl-Ishlinskii operator of up to 8 stops, whose thresholds halve from half of the greatest depth
//               down to the encoder step
//   creep       bristles that creep by a power law, one time a decade, from 1 ms to the same limit
// `encoder_step_m`: 0 where positions are not quantised.
FeatureList dictionary(const TrainingExtent& extent, double encoder_step_m);
// Its relaxation times in s, ascending.
std::vector<double> dictionary_times_s(const TrainingExtent& extent);
// A list with one feature for each relaxation time.
FeatureList single_times(bool velocity, const std::vector<double>& times_s);
// The name of a candidate feature in reports, with the range of its constants.
std::string term_name(const FeatureSpec& spec);

// The drive curve of a branch, or the friction curve of a stop or creeping bristle, from its kCurveTerms weights.
DriveCurve combined_curve(FeatureKind kind, const double* weights, double reference_depth_m);
// The kCurveTerms curves of its basis.
std::vector<DriveCurve> curve_basis(FeatureKind kind, double reference_depth_m);

// The parameters that all regressions of one training have in common.
struct TrendProblem {
  double reference_depth_m = 0.0;
  double rms_velocity_m_per_s = 0.0;  // v_0
  double force_noise_floor_N = 0.0;   // at or below it a sample has no measured force
  Weighting weighting = Weighting::jnd;
  JndLine jnd{};
  int folds = 1;
};

// The values of a row other than its basis functions.
struct TrendRow {
  double force_N = 0.0;
  double velocity_m_per_s = 0.0;
  double depth_m = 0.0;
  double lag_m = 0.0;  // of the material's surface: s - d
  int fold = 0;        // cross_validation.h
};

using ColumnList = std::vector<Eigen::Index>;

class TrendRows {
 public:
  // Every `stride`-th of the samples in contact makes a row.
  TrendRows(FeatureList list, const TrendProblem& problem, std::size_t stride = 1);

  // Adds the next sample, in contact or not.
  void add(const MotionRow& sample);

  std::size_t count() const { return rows_.size(); }
  const TrendRow& operator[](std::size_t index) const { return rows_[index]; }
  // The basis functions: one matrix row for each row, one column for each function.
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<const Matrix> terms() const {
    return {values_.data(), static_cast<Eigen::Index>(count()), static_cast<Eigen::Index>(columns())};
  }
  std::size_t columns() const { return columns_; }
  // The columns of each feature of the list.
  const std::vector<ColumnList>& feature_columns() const { return feature_columns_; }
  // The columns of those features of the list for whose index `wanted` is true.
  template <typename Wanted>
  ColumnList columns_of(const Wanted& wanted) const {
    ColumnList columns;
    for (std::size_t f = 0; f < feature_columns_.size(); ++f) {
      if (wanted(f)) columns.insert(columns.end(), feature_columns_[f].begin(), feature_columns_[f].end());
    }
    return columns;
  }
  const FeatureList& list() const { return list_; }
  const TrendProblem& problem() const { return problem_; }

 private:
  void update_branches(double time_s, double depth_m, double surface_m);

  FeatureList list_;
  TrendProblem problem_;
  std::size_t stride_;
  std::size_t seen_ = 0;  // samples in contact
  std::vector<ColumnList> feature_columns_;
  std::size_t columns_ = 0;
  std::vector<double> values_;
  std::vector<TrendRow> rows_;

  std::vector<ElasticSpline> elastic_basis_;
  std::vector<FeatureFilter> surface_;   // size 0 or 1
  std::vector<FeatureFilter> bristles_;  // kCurveTerms values each
  // The Maxwell branches: those of each curve for all relaxation times.
  std::array<BranchLanes, kCurveTerms> branches_;
  std::array<PartMemory, kCurveTerms> branch_memory_{};
  std::size_t branch_count_ = 0;
  double last_time_s_ = 0.0;  // as the next two, at the last sample
  double last_depth_m_ = 0.0;
  double last_surface_m_ = 0.0;
  bool started_ = false;
};

// The training data of all regressions of one step of a fit.
struct TrendData {
  MotionSource& source;
  TrendProblem problem;
  FitControl control;
};

// The rows with the list's terms. If there are more than `most_rows`, only every n-th is kept, n a power of two.
// Samples that follow the last used one by less than `least_step_s` are skipped. Errors: interrupted.
Result<TrendRows> gather_rows(const TrendData& data, const FeatureList& list, std::size_t most_rows,
                              double least_step_s = 0.0);

// The surface_lag feature of an elastic response: a cubic spline with only the kDriveKnots knots of a DriveCurve,
// through the response at the knot averages (Schoenberg's variation diminishing approximation; de Boor, "A practical
// guide to splines", chapter 11). It rises where the response rises.
FeatureSpec surface_lag_of(const ElasticSpline& elastic, double reference_depth_m);

struct FittedTrend {
  Trend trend;
  std::vector<FeatureSpec> features;
  // Features x rows: the features at each row, SI.
  Eigen::MatrixXd row_features;
};
// The trend and features for the weights `x` of the regression on `rows`. `all`: keep features whose weights are 0.
FittedTrend fitted_trend(const TrendRows& rows, const Eigen::VectorXd& x, bool all);

}  // namespace palpate
