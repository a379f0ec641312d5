#include "models/training/trend_rows.h"

#include <algorithm>
#include <array>
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

// The Bernstein polynomials, computed once because every row uses them.
constexpr auto kViscousBasis = [] {
  std::array<std::array<double, kViscosityCoefficients>, kViscosityCoefficients> basis{};
  for (std::size_t k = 0; k < basis.size(); ++k) basis[k] = bernstein<kViscosityCoefficients - 1>(k);
  return basis;
}();

// Makes one feature for each term of a bristle.
std::vector<FeatureSpec> bristle_basis(FeatureKind kind, double threshold_m, double time_s, double reference_depth_m) {
  std::vector<FeatureSpec> specs(kBristleTerms);
  for (std::size_t k = 0; k < kBristleTerms; ++k) {
    std::array<double, kBristleTerms> one{};
    one[k] = 1.0;
    specs[k].kind = kind;
    specs[k].part_count = 1;
    specs[k].parts[0] = {time_s, threshold_m, combined_friction(one.data(), reference_depth_m)};
  }
  return specs;
}

}  // namespace

std::vector<DriveCurve> branch_curves(double reference_depth_m) {
  std::vector<DriveCurve> curves;
  for (std::size_t k = 0; k < kBranchTerms; ++k) {
    std::array<double, kBranchTerms> one{};
    one[k] = 1.0;
    curves.push_back(combined_drive(one.data(), reference_depth_m));
  }
  return curves;
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
  constexpr std::array<std::array<double, kDriveCoefficients>, kBristleTerms> kShapes{
      {{4.0, -6.0, 4.0, -1.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}};
  DriveCurve drive;
  drive.reference_depth_m = reference_depth_m;
  for (std::size_t k = 0; k < kBristleTerms; ++k) {
    for (std::size_t j = 0; j < kDriveCoefficients; ++j) drive.coefficient_N[j] += weights[k] * kShapes[k][j];
  }
  return drive;
}

DriveCurve coarse_curve(const ElasticSpline& elastic, double reference_depth_m) {
  constexpr std::size_t kCoarsePieces = kDriveKnots + 1;
  constexpr double kWidth = 1.0 / kCoarsePieces;
  // The Greville abscissae in units of a piece.
  std::array<double, kCoarsePieces + 3> average{};
  for (std::size_t i = 1; i <= kCoarsePieces + 1; ++i) average[i] = static_cast<double>(i) - 1.0;
  average[1] = 1.0 / 3.0;
  average[kCoarsePieces + 1] = kCoarsePieces - 1.0 / 3.0;
  average[kCoarsePieces + 2] = kCoarsePieces;
  // The slope is a quadratic B-spline: its weights, and the second derivative of the curve at each knot.
  std::array<double, kCoarsePieces + 2> weight{};
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = (elastic.at(average[i + 1] * kWidth) - elastic.at(average[i] * kWidth)) /
                ((average[i + 1] - average[i]) * kWidth);
  }
  std::array<double, kCoarsePieces + 1> bend{};
  for (std::size_t k = 0; k <= kCoarsePieces; ++k) {
    bend[k] = (k == 0 || k == kCoarsePieces ? 2.0 : 1.0) * (weight[k + 1] - weight[k]) / kWidth;
  }
  const auto cube = [&](std::size_t piece) { return (bend[piece + 1] - bend[piece]) / (6.0 * kWidth); };
  DriveCurve curve;
  curve.reference_depth_m = reference_depth_m;
  curve.has_knots = true;
  curve.coefficient_N = {weight[0], 0.5 * bend[0], cube(0), 0.0};
  for (std::size_t k = 0; k < kDriveKnots; ++k) curve.knot_N[k] = cube(k + 1) - cube(k);
  return curve;
}

TrendRows::TrendRows(TrendTerms terms, std::size_t most_rows)
    : terms_(std::move(terms)),
      most_rows_(most_rows),
      ladder_(terms_.relaxation_times_s, branch_curves(terms_.reference_depth_m), terms_.slowing),
      elastic_basis_(spline_basis()) {
  if (!terms_.surface.empty()) surface_.emplace_back(terms_.surface);
  for (const double threshold_m : terms_.stop_thresholds_m) {
    bristles_.emplace_back(bristle_basis(FeatureKind::stops, threshold_m, 0.0, terms_.reference_depth_m));
  }
  for (const double time_s : terms_.creep_times_s) {
    bristles_.emplace_back(
        bristle_basis(FeatureKind::creep, terms_.reference_depth_m, time_s, terms_.reference_depth_m));
  }
  columns_ = first_creep() + kBristleTerms * terms_.creep_times_s.size();
}

std::size_t TrendRows::viscous_columns() const {
  return terms_.thinning_velocity_m_per_s > 0.0 ? 2 * kViscosityCoefficients : 0;
}

void TrendRows::begin_recording() {
  ladder_.reset();
  for (auto* filters : {&surface_, &bristles_}) {
    for (FeatureFilter& filter : *filters) filter.reset();
  }
}

void TrendRows::advance(const ToolSample& sample, const MotionEstimate& motion) {
  for (auto* filters : {&surface_, &bristles_}) {
    for (FeatureFilter& filter : *filters) filter.update(sample, motion);
  }
  const double depth_m = std::max(0.0, motion.position_m);
  ladder_.update(sample.time_s, depth_m, surface_.empty() ? depth_m : surface_.front().surface_m());
}

void TrendRows::add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int fold) {
  advance(sample, motion);
  if (!(sample.position_m > 0.0)) return;
  if (phase_++ % stride_ != 0) return;
  const double depth_m = std::max(0.0, motion.position_m);
  const double velocity_m_per_s = depth_m > 0.0 ? motion.velocity_m_per_s : 0.0;
  const double u = std::min(depth_m / terms_.reference_depth_m, 1.0);
  values_.resize(values_.size() + columns_);
  double* to = values_.data() + (values_.size() - columns_);
  for (const ElasticSpline& curve : elastic_basis_) *to++ = curve.at(u);
  if (viscous_columns() > 0) {
    for (const double v : {velocity_m_per_s, thinned_velocity(velocity_m_per_s, terms_.thinning_velocity_m_per_s)}) {
      for (const auto& power : kViscousBasis) *to++ = v * polynomial(power, u);
    }
  }
  to = std::copy(ladder_.values().begin(), ladder_.values().end(), to);
  for (const FeatureFilter& bristle : bristles_) to = std::copy_n(bristle.vector().values.begin(), kBristleTerms, to);
  force_N_.push_back(force_N);
  velocity_m_per_s_.push_back(velocity_m_per_s);
  depth_m_.push_back(depth_m);
  lag_m_.push_back(surface_.empty() ? 0.0 : surface_.front().surface_m() - depth_m);
  fold_.push_back(fold);
  if (count() > most_rows_) halve();
}

void TrendRows::halve() {
  keep_every_other(values_, columns_);
  keep_every_other(force_N_, 1);
  keep_every_other(velocity_m_per_s_, 1);
  keep_every_other(depth_m_, 1);
  keep_every_other(lag_m_, 1);
  keep_every_other(fold_, 1);
  stride_ *= 2;
  phase_ = 1;  // the newest row was kept
}

}  // namespace palpate
