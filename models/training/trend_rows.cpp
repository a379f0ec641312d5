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

// Of every k, once: the sums of a row are many.
constexpr auto kElasticBasis = [] {
  std::array<std::array<double, kElasticCoefficients>, kElasticCoefficients> basis{};
  for (std::size_t k = 0; k < basis.size(); ++k) basis[k] = bernstein_integral<kElasticCoefficients - 1>(k);
  return basis;
}();
constexpr auto kViscousBasis = [] {
  std::array<std::array<double, kViscosityCoefficients>, kViscosityCoefficients> basis{};
  for (std::size_t k = 0; k < basis.size(); ++k) basis[k] = bernstein<kViscosityCoefficients - 1>(k);
  return basis;
}();

// Of the weight of the data themselves: it decides only where they say nothing.
constexpr double kSmoothness = 1e-4;
constexpr std::size_t kSplinePieces = kDriveKnots + 1;
constexpr double kSplinePiece = 1.0 / kSplinePieces;

// The knots of the quadratic B-splines: the ends three times.
double knot_at(std::size_t i) {
  const auto inner = static_cast<double>(std::clamp<std::size_t>(i, 2, kSplinePieces + 2) - 2);
  return inner * kSplinePiece;
}

// N_i of a degree at u (Cox-de Boor recursion); at u = 1 its limit from the left.
double b_spline(std::size_t i, int degree, double u) {
  const double first = knot_at(i);
  if (degree == 0) {
    const double next = knot_at(i + 1);
    return (u >= first && u < next) || (u >= 1.0 && first < next && next >= 1.0) ? 1.0 : 0.0;
  }
  const auto width = static_cast<std::size_t>(degree);
  double value = 0.0;
  if (const double rise = knot_at(i + width) - first; rise > 0.0) value += (u - first) / rise * b_spline(i, degree - 1, u);
  const double end = knot_at(i + width + 1);
  if (const double fall = end - knot_at(i + 1); fall > 0.0) value += (end - u) / fall * b_spline(i + 1, degree - 1, u);
  return value;
}

std::vector<DriveCurve> branch_curves(const TrendTerms& terms) {
  if (terms.spline_branches) return spline_basis(terms.reference_depth_m);
  std::vector<DriveCurve> curves;
  for (const FeatureSpec& spec : branch_basis(1.0, terms.reference_depth_m)) curves.push_back(spec.drive);
  return curves;
}

}  // namespace

std::vector<DriveCurve> spline_basis(double reference_depth_m) {
  std::vector<DriveCurve> basis(kSplineTerms);
  for (std::size_t i = 0; i < kSplineTerms; ++i) {
    DriveCurve& curve = basis[i];
    curve.reference_depth_m = reference_depth_m;
    curve.has_knots = true;
    double before = 0.0;  // coefficient of the square on the piece before
    for (std::size_t piece = 0; piece < kSplinePieces; ++piece) {
      const double begin = kSplinePiece * static_cast<double>(piece);
      const double at_begin = b_spline(i, 2, begin);
      const double at_end = b_spline(i, 2, piece + 1 == kSplinePieces ? 1.0 : begin + kSplinePiece);
      const double square = 2.0 * (at_begin - 2.0 * b_spline(i, 2, begin + 0.5 * kSplinePiece) + at_end) / (kSplinePiece * kSplinePiece);
      if (piece == 0) {
        curve.coefficient_N = {at_begin, 0.5 * ((at_end - at_begin) / kSplinePiece - square * kSplinePiece), square / 3.0, 0.0};
      } else {
        curve.knot_N[piece - 1] = (square - before) / 3.0;
      }
      before = square;
    }
  }
  return basis;
}

DriveCurve combined_spline(const double* weights, double reference_depth_m) {
  DriveCurve sum;
  sum.reference_depth_m = reference_depth_m;
  sum.has_knots = true;
  const std::vector<DriveCurve> basis = spline_basis(reference_depth_m);
  for (std::size_t i = 0; i < kSplineTerms; ++i) {
    for (std::size_t j = 0; j < kDriveCoefficients; ++j) sum.coefficient_N[j] += weights[i] * basis[i].coefficient_N[j];
    for (std::size_t j = 0; j < kDriveKnots; ++j) sum.knot_N[j] += weights[i] * basis[i].knot_N[j];
  }
  return sum;
}

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

TrendRows::TrendRows(TrendTerms terms, std::size_t most_rows)
    : terms_(std::move(terms)),
      most_rows_(most_rows),
      ladder_(terms_.relaxation_times_s, branch_curves(terms_), terms_.slowing) {
  if (!terms_.surface.empty()) surface_.emplace_back(terms_.surface);
  if (terms_.spline_elastic) elastic_basis_ = spline_basis(terms_.reference_depth_m);
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
    stops_.emplace_back(specs);
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
  ladder_.reset();
  for (auto* filters : {&surface_, &stops_, &peaks_}) {
    for (FeatureFilter& filter : *filters) filter.reset();
  }
}

void TrendRows::advance(const ToolSample& sample, const MotionEstimate& motion) {
  for (auto* filters : {&surface_, &stops_, &peaks_}) {
    for (FeatureFilter& filter : *filters) filter.update(sample, motion);
  }
  const double depth_m = std::max(0.0, motion.position_m);
  ladder_.update(sample.time_s, depth_m, surface_.empty() ? depth_m : surface_.front().surface_m());
}

void TrendRows::add(const ToolSample& sample, const MotionEstimate& motion, double force_N, int stroke) {
  advance(sample, motion);
  if (!(sample.position_m > 0.0)) return;
  if (phase_++ % stride_ != 0) return;
  const double depth_m = std::max(0.0, motion.position_m);
  const double velocity_m_per_s = depth_m > 0.0 ? motion.velocity_m_per_s : 0.0;
  const double u = std::min(depth_m / terms_.reference_depth_m, 1.0);
  values_.resize(values_.size() + columns_);
  double* to = values_.data() + (values_.size() - columns_);
  for (const DriveCurve& curve : elastic_basis_) *to++ = curve.at(depth_m);
  if (elastic_basis_.empty()) {
    for (const auto& power : kElasticBasis) *to++ = u * polynomial(power, u);
  }
  if (viscous_columns() > 0) {
    for (const double v : {velocity_m_per_s, thinned_velocity(velocity_m_per_s, terms_.thinning_velocity_m_per_s)}) {
      for (const auto& power : kViscousBasis) *to++ = v * polynomial(power, u);
    }
  }
  to = std::copy(ladder_.values().begin(), ladder_.values().end(), to);
  for (const FeatureFilter& stop : stops_) to = std::copy_n(stop.vector().values.begin(), kStopTerms, to);
  put_softening(depth_m, to);
  force_N_.push_back(force_N);
  velocity_m_per_s_.push_back(velocity_m_per_s);
  depth_m_.push_back(depth_m);
  stroke_.push_back(stroke);
  if (count() > most_rows_) halve();
}

void TrendRows::put_softening(double depth_m, double* to) const {
  for (const FeatureFilter& peak : peaks_) {
    for (const double share : softening_shares(depth_m, peak.vector().values[0])) {
      for (const DriveCurve& basis : softening_basis_) *to++ = share * basis.at(depth_m);
    }
  }
}

void TrendRows::smooth_splines(Eigen::MatrixXd& gram) const {
  const auto smooth = [&](std::size_t first) {
    const auto begin = static_cast<Eigen::Index>(first);
    const double weight = kSmoothness * gram.diagonal().segment(begin, kSplineTerms).mean();
    for (auto i = begin; i + 1 < begin + static_cast<Eigen::Index>(kSplineTerms); ++i) {
      gram(i, i) += weight;
      gram(i + 1, i + 1) += weight;
      gram(i, i + 1) -= weight;
      gram(i + 1, i) -= weight;
    }
  };
  if (terms_.spline_elastic) smooth(0);
  if (!terms_.spline_branches) return;
  for (std::size_t t = 0; t < terms_.relaxation_times_s.size(); ++t) smooth(first_branch() + t * kSplineTerms);
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
