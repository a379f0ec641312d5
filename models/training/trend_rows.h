// The rows of the trend's regression, gathered from recordings in one pass and
// bounded memory.
//
// Each row holds the trend's basis at one sample in contact:
//   elastic    int_0^u of the quadratic B-splines (models/model/elastic_spline.h)
//   viscous    v B_k,2(min(u, 1))      k = 0..2, when the scene has velocity,
//              then the same with v / (1 + |v| / v_0)
//   branch     Maxwell filter driven by int_0^u B_k,2, k = 0..2, per relaxation time
//   stop       s / r times 1 - (1 - u)^4, u and u^2, per threshold r
//   creep      q / r times the same, per time at the greatest depth r
// With a `surface`, branches follow the material's surface instead of the tool
// (engine/tick/features.h).
// The filters are the features' own code, or that of branch_ladder.h. When more than
// kMaximumTrendRows rows (or as many as asked for) come, every other one is dropped and the stride
// doubles.
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
// Where many regressions are compared.
inline constexpr std::size_t kSearchedRows = 4000;
inline constexpr std::size_t kBranchTerms = 3;

// The three branch features of one relaxation time whose weighted sum can be
// any branch; the weights become one DriveCurve by `combined_drive`.
std::vector<FeatureSpec> branch_basis(double relaxation_time_s, double reference_depth_m);
DriveCurve combined_drive(const double* weights, double reference_depth_m);

// The elastic response with the kDriveKnots knots of a DriveCurve, which is enough to say where the
// surface is: a cubic spline through the response at the knot averages (Schoenberg's variation diminishing
// approximation; de Boor, "A practical guide to splines", chapter 11), which rises where the response does.
DriveCurve coarse_curve(const ElasticSpline& elastic, double reference_depth_m);

// What a trend may consist of besides its elastic response, and in which basis.
struct TrendTerms {
  double reference_depth_m = 1.0;
  double thinning_velocity_m_per_s = 0.0;  // v_0; 0: no viscosity
  std::vector<double> relaxation_times_s;
  std::vector<double> stop_thresholds_m;
  std::vector<double> creep_times_s{};
  double slowing = 0.0;  // of the relaxation times with depth
  // A surface_lag and the branches that decide where the surface is; none: it is under the tool.
  std::vector<FeatureSpec> surface{};
};

inline constexpr std::size_t kBristleTerms = 3;

// g of a bristle from its kBristleTerms weights: as many shapes of rising friction.
DriveCurve combined_friction(const double* weights, double reference_depth_m);

class TrendRows {
 public:
  explicit TrendRows(TrendTerms terms, std::size_t most_rows = kMaximumTrendRows);

  // A new recording begins: filters start anew.
  void begin_recording();
  // Every sample in order, in contact or not. `fold`: fold_dealer.h.
  void add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int fold);

  // A sample that only moves the filters and makes no row.
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
  // Where the columns of each kind begin; those of the elastic response begin at 0.
  std::size_t first_branch() const { return kElasticTerms + viscous_columns(); }
  std::size_t first_stop() const { return first_branch() + kBranchTerms * terms_.relaxation_times_s.size(); }
  std::size_t first_creep() const { return first_stop() + kBristleTerms * terms_.stop_thresholds_m.size(); }

 private:
  void halve();

  TrendTerms terms_;
  std::size_t most_rows_;
  BranchLadder ladder_;
  std::vector<FeatureFilter> surface_;   // one or none
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
