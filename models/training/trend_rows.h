// The rows of the regression of the trend, gathered from recordings in one pass and bounded memory.
//
// Each row holds the basis functions of the trend at one sample in contact, u = depth / reference depth:
//   elastic    int_0^u of the quadratic B-splines (models/model/trend.h)
//   viscous    v B_k,2(min(u, 1))      k = 0..2, if the list has velocity,
//              then the same with v / (1 + |v| / v_0)
//   branch     Maxwell branch driven by int_0^u B_k,2, k = 0..2, for each relaxation time
//   stop       s / r times 1 - (1 - u)^4, u and u^2, for each threshold r
//   creep      q / r times the same, for each time; r is the greatest depth
// With a `surface`, branches follow the material's surface instead of the tool (engine/tick/features.h). The filters
// are those of the features or a BranchLadder. When there are more than `most_rows` rows, every other one is dropped
// and the stride doubles.
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"
#include "models/model/trend.h"
#include "models/training/weighting.h"

namespace palpate {

// The basis functions of depth of each branch, stop and creeping bristle.
inline constexpr std::size_t kCurveTerms = 3;

// The terms of a trend besides its elastic response, by the features that they make.
struct FeatureList {
  bool velocity = false;
  // One inner list per feature: the times (seconds) whose branches it sums.
  std::vector<std::vector<double>> relaxation_times_s;
  std::vector<double> stop_thresholds_m;  // of one feature, the sum of the stops
  std::vector<double> creep_times_s;      // of one feature, the sum of the bristles
  double slowing = 0.0;                   // growth of the relaxation times with depth
  // A surface_lag feature and the branches that determine the surface; empty: the surface does not lag.
  std::vector<FeatureSpec> surface{};

  // The relaxation times of all features, in order.
  std::vector<double> all_times_s() const;
};

// The parameters that all regressions of one training have in common.
struct TrendProblem {
  double reference_depth_m = 0.0;
  double rms_velocity_m_per_s = 0.0;  // v_0
  double force_noise_floor_N = 0.0;   // at or below it a sample has no measured force
  Weighting weighting = Weighting::jnd;
  JndLine jnd{};
  int folds = 1;
};

// The drive curve of a branch, or the friction curve of a stop or creeping bristle, from its kCurveTerms weights.
DriveCurve combined_curve(FeatureKind kind, const double* weights, double reference_depth_m);
// The kCurveTerms curves of its basis.
std::vector<DriveCurve> curve_basis(FeatureKind kind, double reference_depth_m);

// The elastic response with only the kDriveKnots knots of a DriveCurve, for surface_lag: a cubic spline through the
// response at the knot averages (Schoenberg's variation diminishing approximation; de Boor, "A practical guide to
// splines", chapter 11). It rises where the response rises.
DriveCurve coarse_curve(const ElasticSpline& elastic, double reference_depth_m);

// Maxwell branches for all relaxation times tau_t and all drive curves g_k at once: the outputs z_tk of
//   dz/dt = g_k'(s) ds/dt - z / tau_t
// with s the depth of the material's surface (engine/tick/features.h), discretised as there. Each curve is evaluated
// once a sample and each decay once a relaxation time.
class BranchLadder {
 public:
  // `slowing`: growth of all relaxation times with depth (FeatureSpec::slowing).
  BranchLadder(std::vector<double> times_s, double reference_depth_m, double slowing);

  void reset() { started_ = false; }
  // Adds the next sample; times increase. `depth_m`: depth of the tool, at most `surface_m`, that of the surface.
  void update(double time_s, double depth_m, double surface_m);
  // z_tk, index t * kCurveTerms + k.
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> times_s_;
  std::vector<DriveCurve> curves_;
  double slowing_;
  std::vector<double> values_;
  std::array<double, kCurveTerms> drive_{};  // g_k at the last sample
  double time_s_ = 0.0;
  double depth_m_ = 0.0;
  double surface_m_ = 0.0;
  bool started_ = false;
};

// A row besides its basis functions.
struct TrendRow {
  double force_N = 0.0;
  double velocity_m_per_s = 0.0;
  double depth_m = 0.0;
  double lag_m = 0.0;  // of the surface
  int fold = 0;        // cross_validation.h
};

class TrendRows {
 public:
  TrendRows(FeatureList list, const TrendProblem& problem, std::size_t most_rows);

  // Resets the filters for a new recording.
  void begin_recording();
  // Adds the next sample, in contact or not; only samples in contact make rows.
  void add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int fold);
  // Updates the filters with a sample that makes no row.
  void advance(const ToolSample& sample, const MotionEstimate& motion);

  std::size_t count() const { return rows_.size(); }
  const TrendRow& operator[](std::size_t index) const { return rows_[index]; }
  // The basis functions, one row for each row.
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<const Matrix> terms() const {
    return {values_.data(), static_cast<Eigen::Index>(count()), static_cast<Eigen::Index>(columns_)};
  }
  const FeatureList& list() const { return list_; }
  const TrendProblem& problem() const { return problem_; }

  std::size_t columns() const { return columns_; }
  std::size_t viscous_columns() const { return list_.velocity ? 2 * kViscosityCoefficients : 0; }
  // The first column of each kind of term; the elastic response begins at 0.
  std::size_t first_branch() const { return kElasticTerms + viscous_columns(); }
  std::size_t first_stop() const { return first_branch() + ladder_.values().size(); }

 private:
  void halve();

  FeatureList list_;
  TrendProblem problem_;
  std::size_t most_rows_;
  BranchLadder ladder_;
  std::vector<FeatureFilter> surface_;   // size 0 or 1
  std::vector<FeatureFilter> bristles_;  // kCurveTerms values each
  std::vector<ElasticSpline> elastic_basis_;
  std::size_t columns_;
  std::vector<double> values_;
  std::vector<TrendRow> rows_;
  std::size_t stride_ = 1;
  std::size_t phase_ = 0;
};

}  // namespace palpate
