#include "models/training/trend_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "models/model/bernstein.h"

namespace palpate {
namespace {

// Keeps the first, third, ... of the groups of `width` values.
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

// Coefficients of u^1 .. u^4: the integrals of the Bernstein polynomials, and the friction of a bristle.
constexpr std::array kDrives{bernstein_integral<kCurveTerms - 1>(0), bernstein_integral<kCurveTerms - 1>(1),
                             bernstein_integral<kCurveTerms - 1>(2)};
constexpr std::array<std::array<double, kDriveCoefficients>, kCurveTerms> kFrictions{
    {{4.0, -6.0, 4.0, -1.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}};

template <typename Shapes>
DriveCurve weighted_sum(const Shapes& shapes, const double* weights, double reference_depth_m) {
  DriveCurve curve;
  curve.reference_depth_m = reference_depth_m;
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    for (std::size_t j = 0; j < shapes[k].size(); ++j) curve.coefficient_N[j] += weights[k] * shapes[k][j];
  }
  return curve;
}

// One feature for each term of a bristle.
FeatureFilter bristle(FeatureKind kind, double threshold_m, double time_s, double reference_depth_m) {
  std::vector<FeatureSpec> specs;
  for (const DriveCurve& curve : curve_basis(kind, reference_depth_m)) {
    FeatureSpec& spec = specs.emplace_back();
    spec.kind = kind;
    spec.part_count = 1;
    spec.parts[0] = {time_s, threshold_m, curve};
  }
  return FeatureFilter(specs);
}

}  // namespace

std::vector<double> FeatureList::all_times_s() const {
  std::vector<double> times_s;
  for (const auto& group : relaxation_times_s) times_s.insert(times_s.end(), group.begin(), group.end());
  return times_s;
}

DriveCurve combined_curve(FeatureKind kind, const double* weights, double reference_depth_m) {
  return is_bristle(kind) ? weighted_sum(kFrictions, weights, reference_depth_m)
                          : weighted_sum(kDrives, weights, reference_depth_m);
}

std::vector<DriveCurve> curve_basis(FeatureKind kind, double reference_depth_m) {
  std::vector<DriveCurve> curves;
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    std::array<double, kCurveTerms> one{};
    one[k] = 1.0;
    curves.push_back(combined_curve(kind, one.data(), reference_depth_m));
  }
  return curves;
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

BranchLadder::BranchLadder(std::vector<double> times_s, double reference_depth_m, double slowing)
    : times_s_(std::move(times_s)),
      curves_(curve_basis(FeatureKind::maxwell_spectrum, reference_depth_m)),
      slowing_(slowing),
      values_(times_s_.size() * kCurveTerms, 0.0) {}

void BranchLadder::update(double time_s, double depth_m, double surface_m) {
  if (times_s_.empty()) return;
  std::array<double, kCurveTerms> change{};
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    const double drive = curves_[k].at(surface_m);
    change[k] = drive - drive_[k];
    drive_[k] = drive;
  }
  const double step_s = time_s - time_s_;
  if (!started_) {
    std::fill(values_.begin(), values_.end(), 0.0);
  } else if (step_s > 0.0) {
    const double halfway_m = surface_halfway(surface_m_, depth_m_, depth_m);
    const double factor = relaxation_time_factor(slowing_, halfway_m, curves_.front().reference_depth_m);
    double* value = values_.data();
    for (const double relaxation_time_s : times_s_) {
      const BranchStep step = branch_step(factor * relaxation_time_s, step_s);
      for (std::size_t k = 0; k < kCurveTerms; ++k, ++value) {
        *value = step.keep * *value + step.gain * change[k];
        if (std::abs(*value) < 1e-30) *value = 0.0;
      }
    }
  }
  started_ = true;
  time_s_ = time_s;
  depth_m_ = depth_m;
  surface_m_ = surface_m;
}

TrendRows::TrendRows(FeatureList list, const TrendProblem& problem, std::size_t most_rows)
    : list_(std::move(list)),
      problem_(problem),
      most_rows_(most_rows),
      ladder_(list_.all_times_s(), problem.reference_depth_m, list_.slowing),
      elastic_basis_(spline_basis()) {
  const double depth_m = problem_.reference_depth_m;
  if (!list_.surface.empty()) surface_.emplace_back(list_.surface);
  for (const double threshold_m : list_.stop_thresholds_m) {
    bristles_.push_back(bristle(FeatureKind::stops, threshold_m, 0.0, depth_m));
  }
  for (const double time_s : list_.creep_times_s) {
    bristles_.push_back(bristle(FeatureKind::creep, depth_m, time_s, depth_m));
  }
  columns_ = first_stop() + kCurveTerms * bristles_.size();
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
  const double u = std::min(depth_m / problem_.reference_depth_m, 1.0);
  values_.resize(values_.size() + columns_);
  double* to = values_.data() + (values_.size() - columns_);
  for (const ElasticSpline& curve : elastic_basis_) *to++ = curve.at(u);
  if (list_.velocity) {
    for (const double v : {velocity_m_per_s, thinned_velocity(velocity_m_per_s, problem_.rms_velocity_m_per_s)}) {
      for (const auto& power : kViscousBasis) *to++ = v * polynomial(power, u);
    }
  }
  to = std::copy(ladder_.values().begin(), ladder_.values().end(), to);
  for (const FeatureFilter& filter : bristles_) to = std::copy_n(filter.vector().values.begin(), kCurveTerms, to);
  const double lag_m = surface_.empty() ? 0.0 : surface_.front().surface_m() - depth_m;
  rows_.push_back({force_N, velocity_m_per_s, depth_m, lag_m, fold});
  if (count() > most_rows_) halve();
}

void TrendRows::halve() {
  keep_every_other(values_, columns_);
  keep_every_other(rows_, 1);
  stride_ *= 2;
  phase_ = 1;  // the newest row was kept
}

}  // namespace palpate
