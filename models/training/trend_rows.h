// The rows of the trend's regression, gathered from recordings in one pass and
// bounded memory.
//
// Each row holds the trend's basis at one sample in contact:
//   elastic    int_0^u B_k,5           k = 0..5
//   viscous    v B_k,2(min(u, 1))      k = 0..2, when the scene has velocity,
//              then the same with v / (1 + |v| / v_0)
//   branch     Maxwell filter driven by int_0^u B_k,2, k = 0..2, per relaxation time
// The branch filters are the features' own code. When more than
// kMaximumTrendRows rows come, every other one is dropped and the stride
// doubles.
// Thread guarantee: slow side.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

inline constexpr std::size_t kMaximumTrendRows = 100000;
inline constexpr std::size_t kBranchTerms = 3;

// The three branch features of one relaxation time whose weighted sum can be
// any branch; the weights become one DriveCurve by `combined_drive`.
std::vector<FeatureSpec> branch_basis(double relaxation_time_s, double reference_depth_m);
DriveCurve combined_drive(const double* weights, double reference_depth_m);

class TrendRows {
 public:
  // `thinning_velocity_m_per_s`: v_0; 0 when the scene has no velocity.
  TrendRows(double reference_depth_m, double thinning_velocity_m_per_s, std::vector<double> relaxation_times_s);

  // A new recording begins: filters start anew.
  void begin_recording();
  // Every sample in order, in contact or not. `stroke` numbers contacts.
  void add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int stroke);

  // A sample that only moves the filters and makes no row.
  void advance(const ToolSample& sample, const MotionEstimate& motion);

  std::size_t columns() const { return columns_; }
  std::size_t viscous_columns() const;
  std::size_t count() const { return force_N_.size(); }
  const double* row(std::size_t index) const { return values_.data() + index * columns_; }
  double force_N(std::size_t index) const { return force_N_[index]; }
  double velocity_m_per_s(std::size_t index) const { return velocity_m_per_s_[index]; }
  double depth_m(std::size_t index) const { return depth_m_[index]; }
  int stroke(std::size_t index) const { return stroke_[index]; }
  double reference_depth_m() const { return reference_depth_m_; }
  double thinning_velocity_m_per_s() const { return thinning_velocity_m_per_s_; }
  const std::vector<double>& relaxation_times_s() const { return relaxation_times_s_; }

 private:
  void halve();

  double reference_depth_m_;
  double thinning_velocity_m_per_s_;
  std::vector<double> relaxation_times_s_;
  std::vector<FeatureFilter> branches_;
  std::size_t columns_;
  std::vector<double> values_;
  std::vector<double> force_N_;
  std::vector<double> velocity_m_per_s_;
  std::vector<double> depth_m_;
  std::vector<int> stroke_;
  std::size_t stride_ = 1;
  std::size_t phase_ = 0;
};

}  // namespace palpate
