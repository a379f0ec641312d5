// The rows of the regression of the trend, gathered from recordings in one pass and bounded memory.
//
// Each row holds the basis functions of the trend at one sample in contact, u = depth / reference depth:
//   elastic    int_0^u of the quadratic B-splines (models/model/trend.h)
//   viscous    v B_k,2(min(u, 1))      k = 0..2, if the model has velocity,
//              then the same with v / (1 + |v| / v_0)
//   branch     Maxwell branch driven by int_0^u B_k,2, k = 0..2, for each relaxation time
//   stop       s / r times 1 - (1 - u)^4, u and u^2, for each threshold r
//   creep      q / r times the same, for each time; r is the greatest depth
// With a `surface`, branches follow the material's surface instead of the tool (engine/tick/features.h). The filters
// are those of the features or branch_ladder.h. When there are more than `most_rows` rows, every other one is dropped
// and the stride doubles.
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/tool_sample.h"
#include "models/model/trend.h"
#include "models/training/branch_ladder.h"

namespace palpate {

inline constexpr std::size_t kMaximumTrendRows = 100000;
// The limit where many regressions are compared.
inline constexpr std::size_t kSearchedRows = 4000;
inline constexpr std::size_t kBranchTerms = 3;

// The kBranchTerms drive curves of the basis of a branch. `combined_drive` turns their weights into the drive curve of
// the branch that is their weighted sum.
std::vector<DriveCurve> branch_curves(double reference_depth_m);
DriveCurve combined_drive(const double* weights, double reference_depth_m);

// The elastic response with only the kDriveKnots knots of a DriveCurve, for surface_lag: a cubic spline through the
// response at the knot averages (Schoenberg's variation diminishing approximation; de Boor, "A practical guide to
// splines", chapter 11). It rises where the response rises.
DriveCurve coarse_curve(const ElasticSpline& elastic, double reference_depth_m);

// The terms of a trend besides its elastic response.
struct TrendTerms {
  double reference_depth_m = 1.0;
  double thinning_velocity_m_per_s = 0.0;  // v_0; 0: no viscosity
  std::vector<double> relaxation_times_s;
  std::vector<double> stop_thresholds_m;
  std::vector<double> creep_times_s{};
  double slowing = 0.0;  // growth of the relaxation times with depth
  // A surface_lag feature and the branches that determine the surface; empty: the surface does not lag.
  std::vector<FeatureSpec> surface{};
};

inline constexpr std::size_t kBristleTerms = 3;

// The friction curve g of a bristle from its kBristleTerms weights.
DriveCurve combined_friction(const double* weights, double reference_depth_m);

class TrendRows {
 public:
  explicit TrendRows(TrendTerms terms, std::size_t most_rows = kMaximumTrendRows);

  // Resets the filters for a new recording.
  void begin_recording();
  // Adds the next sample, in contact or not; only samples in contact make rows. `fold`: fold_assignment.h.
  void add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int fold);

  // Updates the filters with a sample that makes no row.
  void advance(const ToolSample& sample, const MotionEstimate& motion);

  std::size_t columns() const { return columns_; }
  std::size_t viscous_columns() const;
  std::size_t count() const { return force_N_.size(); }
  const double* row(std::size_t index) const { return values_.data() + index * columns_; }
  double force_N(std::size_t index) const { return force_N_[index]; }
  double velocity_m_per_s(std::size_t index) const { return velocity_m_per_s_[index]; }
  double depth_m(std::size_t index) const { return depth_m_[index]; }
  double lag_m(std::size_t index) const { return lag_m_[index]; }
  int fold(std::size_t index) const { return fold_[index]; }
  const TrendTerms& terms() const { return terms_; }
  double reference_depth_m() const { return terms_.reference_depth_m; }
  double thinning_velocity_m_per_s() const { return terms_.thinning_velocity_m_per_s; }
  const std::vector<double>& relaxation_times_s() const { return terms_.relaxation_times_s; }
  // The first column of each kind of term; the elastic response begins at 0.
  std::size_t first_branch() const { return kElasticTerms + viscous_columns(); }
  std::size_t first_stop() const { return first_branch() + kBranchTerms * terms_.relaxation_times_s.size(); }
  std::size_t first_creep() const { return first_stop() + kBristleTerms * terms_.stop_thresholds_m.size(); }

 private:
  void halve();

  TrendTerms terms_;
  std::size_t most_rows_;
  BranchLadder ladder_;
  std::vector<FeatureFilter> surface_;   // size 0 or 1
  std::vector<FeatureFilter> bristles_;  // kBristleTerms values each
  std::vector<ElasticSpline> elastic_basis_;
  std::size_t columns_;
  std::vector<double> values_;
  std::vector<double> force_N_;
  std::vector<double> velocity_m_per_s_;
  std::vector<double> depth_m_;
  std::vector<double> lag_m_;
  std::vector<int> fold_;
  std::size_t stride_ = 1;
  std::size_t phase_ = 0;
};

}  // namespace palpate
