#include "models/training/trend_rows.h"

#include <algorithm>
#include <utility>

#include "models/model/bernstein.h"
#include "models/model/trend.h"

namespace palpate {
namespace {

template <typename T>
void keep_every_other(std::vector<T>& values, std::size_t width) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i * width < values.size(); i += 2, ++kept) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * width), width,
                values.begin() + static_cast<std::ptrdiff_t>(kept * width));
  }
  values.resize(kept * width);
}

}  // namespace

std::vector<FeatureSpec> branch_basis(double relaxation_time_s, double reference_depth_m) {
  std::vector<FeatureSpec> specs(kBranchTerms);
  for (std::size_t k = 0; k < kBranchTerms; ++k) {
    std::array<double, kBranchTerms> one{};
    one[k] = 1.0;
    specs[k] = {FeatureKind::maxwell_branch, relaxation_time_s, combined_drive(one.data(), reference_depth_m)};
  }
  return specs;
}

DriveCurve combined_drive(const double* weights, double reference_depth_m) {
  DriveCurve drive;
  drive.reference_depth_m = reference_depth_m;
  for (std::size_t k = 0; k < kBranchTerms; ++k) {
    const auto power = bernstein_integral<kBranchTerms - 1>(k);
    for (std::size_t j = 0; j < power.size(); ++j) drive.coefficient_N[j] += weights[k] * power[j];
  }
  return drive;
}

DriveCurve combined_friction(const double* weights, double reference_depth_m) {
  constexpr std::array<std::array<double, kDriveCoefficients>, kStopTerms> kShapes{
      {{4.0, -6.0, 4.0, -1.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}};
  DriveCurve drive;
  drive.reference_depth_m = reference_depth_m;
  for (std::size_t k = 0; k < kStopTerms; ++k) {
    for (std::size_t j = 0; j < kDriveCoefficients; ++j) drive.coefficient_N[j] += weights[k] * kShapes[k][j];
  }
  return drive;
}

TrendRows::TrendRows(double reference_depth_m, double thinning_velocity_m_per_s,
                     std::vector<double> relaxation_times_s)
    : TrendRows(TrendTerms{reference_depth_m, thinning_velocity_m_per_s, std::move(relaxation_times_s), {}, {}}) {}

TrendRows::TrendRows(TrendTerms terms, std::size_t most_rows) : terms_(std::move(terms)), most_rows_(most_rows) {
  static_assert(kStopTerms == kBranchTerms);
  for (const double time_s : terms_.relaxation_times_s) {
    branches_.emplace_back(branch_basis(time_s, terms_.reference_depth_m));
  }
  for (std::size_t k = 0; k < kBranchTerms; ++k) {
    std::array<double, kBranchTerms> one{};
    one[k] = 1.0;
    softening_basis_[k] = combined_drive(one.data(), terms_.reference_depth_m);
  }
  for (const double threshold_m : terms_.stop_thresholds_m) {
    std::vector<FeatureSpec> specs(kStopTerms);
    for (std::size_t k = 0; k < kStopTerms; ++k) {
      std::array<double, kStopTerms> one{};
      one[k] = 1.0;
      specs[k].kind = FeatureKind::stops;
      specs[k].part_count = 1;
      specs[k].parts[0] = {0.0, threshold_m, combined_friction(one.data(), terms_.reference_depth_m)};
    }
    branches_.emplace_back(specs);
  }
  for (const double time_s : terms_.peak_times_s) {
    peaks_.emplace_back(std::vector<FeatureSpec>{{FeatureKind::fading_peak, time_s}});
  }
  columns_ = first_softening() + kSofteningTerms * peaks_.size();
}

std::size_t TrendRows::viscous_columns() const {
  return terms_.thinning_velocity_m_per_s > 0.0 ? 2 * kViscosityCoefficients : 0;
}

void TrendRows::begin_recording() {
  for (FeatureFilter& branch : branches_) branch.reset();
  for (FeatureFilter& peak : peaks_) peak.reset();
}

void TrendRows::advance(const ToolSample& sample, const MotionEstimate& motion) {
  for (FeatureFilter& branch : branches_) branch.update(sample, motion);
  for (FeatureFilter& peak : peaks_) peak.update(sample, motion);
}

void TrendRows::add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int stroke) {
  advance(sample, motion);
  if (!(sample.position_m > 0.0)) return;
  if (phase_++ % stride_ != 0) return;
  const double depth_m = std::max(0.0, motion.position_m);
  const double velocity_m_per_s = depth_m > 0.0 ? motion.velocity_m_per_s : 0.0;
  const double u = std::min(depth_m / terms_.reference_depth_m, 1.0);
  for (std::size_t k = 0; k < kElasticCoefficients; ++k) {
    values_.push_back(u * polynomial(bernstein_integral<kElasticCoefficients - 1>(k), u));
  }
  if (viscous_columns() > 0) {
    for (const double v : {velocity_m_per_s, thinned_velocity(velocity_m_per_s, terms_.thinning_velocity_m_per_s)}) {
      for (std::size_t k = 0; k < kViscosityCoefficients; ++k) {
        values_.push_back(v * polynomial(bernstein<kViscosityCoefficients - 1>(k), u));
      }
    }
  }
  for (const FeatureFilter& branch : branches_) {
    const auto& branch_values = branch.vector().values;
    values_.insert(values_.end(), branch_values.begin(), branch_values.begin() + kBranchTerms);
  }
  add_softening(depth_m);
  force_N_.push_back(force_N);
  velocity_m_per_s_.push_back(velocity_m_per_s);
  depth_m_.push_back(depth_m);
  stroke_.push_back(stroke);
  if (count() > most_rows_) halve();
}

void TrendRows::add_softening(double depth_m) {
  for (const FeatureFilter& peak : peaks_) {
    for (const double share : softening_shares(depth_m, peak.vector().values[0])) {
      for (const DriveCurve& basis : softening_basis_) values_.push_back(share * basis.at(depth_m));
    }
  }
}

void TrendRows::halve() {
  keep_every_other(values_, columns_);
  keep_every_other(force_N_, 1);
  keep_every_other(velocity_m_per_s_, 1);
  keep_every_other(depth_m_, 1);
  keep_every_other(stroke_, 1);
  stride_ *= 2;
  phase_ = 1;  // the newest row was kept
}

}  // namespace palpate
