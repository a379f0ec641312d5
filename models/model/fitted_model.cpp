#include "models/model/fitted_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/text.h"

namespace palpate {

namespace {

constexpr double kPieces = kElasticPieces;

using Quadratic = std::array<double, 3>;  // coefficients of t^0 to t^2 of a piece

// The three quadratic B-splines that are not 0 on a piece, N_piece to N_piece+2. The knots at the ends are threefold.
std::array<Quadratic, 3> b_splines(std::size_t piece) {
  const double first = piece == 0 ? 1.0 : 0.5;
  const double last = piece + 1 == kElasticPieces ? 1.0 : 0.5;
  return {{{first, -2.0 * first, first}, {1.0 - first, 2.0 * first, -first - last}, {0.0, 0.0, last}}};
}

}  // namespace

std::vector<ElasticSpline> spline_basis() {
  std::vector<ElasticSpline> basis(kElasticTerms);
  for (std::size_t i = 0; i < kElasticTerms; ++i) {
    double sum = 0.0;
    for (std::size_t piece = 0; piece < kElasticPieces; ++piece) {
      double* c = basis[i].pieces_N.data() + piece * kElasticCoefficients;
      c[0] = sum;
      if (i < piece || i > piece + 2) continue;
      const Quadratic spline = b_splines(piece)[i - piece];
      // The integral over u.
      for (std::size_t k = 0; k < spline.size(); ++k) c[k + 1] = spline[k] / (static_cast<double>(k + 1) * kPieces);
      sum += c[1] + c[2] + c[3];
    }
  }
  return basis;
}

ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights) {
  ElasticSpline sum;
  for (std::size_t i = 0; i < basis.size(); ++i)
    for (std::size_t j = 0; j < sum.pieces_N.size(); ++j) sum.pieces_N[j] += weights[i] * basis[i].pieces_N[j];
  return sum;
}

TrendInputs::TrendInputs(const std::vector<FeatureSpec>& specs) noexcept {
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto index = static_cast<std::uint8_t>(i);
    // Low-pass features have no force.
    const FeatureKind kind = specs[i].kind;
    if (kind == FeatureKind::depth) depth = index;
    if (kind == FeatureKind::velocity) velocity = index;
    if (is_branch(kind) || is_bristle(kind)) force[force_count++] = index;
  }
}

double Trend::at(const double* features, const TrendInputs& inputs) const noexcept {
  const double depth_m = inputs.depth != TrendInputs::kNone ? features[inputs.depth] : 0.0;
  const double velocity_m_per_s = inputs.velocity != TrendInputs::kNone ? features[inputs.velocity] : 0.0;
  double memory_N = 0.0;
  for (std::size_t b = 0; b < inputs.force_count; ++b) memory_N += features[inputs.force[b]];
  return trend_equation::trend_at(elastic.pieces_N.data(), viscosity_Ns_per_m.data(), thinning_Ns_per_m.data(),
                                  thinning_velocity_m_per_s, depth_m / reference_depth_m, velocity_m_per_s,
                                  velocity_limit_m_per_s, memory_N);
}

namespace {

// In the normalised feature space, where a feature's spread is about 1: as fine as the pieces of the elastic response.
constexpr double kFirstCoverRadius = 1.0 / kPieces;
constexpr double kCoverGrowth = 1.25;  // a cover is at most a quarter coarser than its points allow

std::vector<Eigen::Index> thinned(const Eigen::MatrixXd& sites, double radius) {
  std::vector<Eigen::Index> kept;
  const auto is_near = [&](const double* x, Eigen::Index other) {
    const double* point = sites.col(other).data();
    double squared = 0.0;
    for (Eigen::Index k = 0; k < sites.rows(); ++k) squared += (x[k] - point[k]) * (x[k] - point[k]);
    return squared <= radius * radius;
  };
  for (Eigen::Index i = 0; i < sites.cols(); ++i) {
    const double* x = sites.col(i).data();
    // Sites are in order of time, so that the newest kept points are the most likely to be near.
    if (std::any_of(kept.rbegin(), kept.rend(), [&](Eigen::Index other) { return is_near(x, other); })) continue;
    if (static_cast<Eigen::Index>(kept.size()) == kMaximumCoverPoints) return {};
    kept.push_back(i);
  }
  return kept;
}

// Sorts a part of `order` so that each of its runs of kCellPoints is a cell: halves with whole cells on the left, along
// the widest dimension.
void sort_to_cells(const Eigen::MatrixXd& points, std::span<Eigen::Index> order) {
  if (order.size() <= simd::kCellPoints) return;
  const Eigen::MatrixXd some = points(Eigen::all, std::vector<Eigen::Index>(order.begin(), order.end()));
  Eigen::Index k = 0;
  (some.rowwise().maxCoeff() - some.rowwise().minCoeff()).maxCoeff(&k);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return points(k, a) != points(k, b) ? points(k, a) < points(k, b) : a < b;
  });
  const std::size_t cells = (order.size() + simd::kCellPoints - 1) / simd::kCellPoints;
  const std::size_t left = cells / 2 * simd::kCellPoints;
  sort_to_cells(points, order.first(left));
  sort_to_cells(points, order.subspan(left));
}

}  // namespace

DomainCover make_cover(const Eigen::MatrixXd& sites) {
  double radius = kFirstCoverRadius;
  std::vector<Eigen::Index> kept;
  while ((kept = thinned(sites, radius)).empty()) radius *= kCoverGrowth;
  DomainCover cover;
  cover.points = sites(Eigen::all, kept);
  // Full trust within a radius of every site, each of which is within a radius of a point of the cover. It ends at the
  // next radius that a fit selects from.
  cover.inner_radius = 2.0 * radius;
  cover.outer_radius = 2.0 * cover.inner_radius;
  return cover;
}

NearestDistance::NearestDistance(const Eigen::MatrixXd& points) : dimension_(static_cast<std::size_t>(points.rows())) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  sort_to_cells(points, order);
  order.resize(simd::whole_vectors(order.size(), simd::kCellPoints), order.back());
  constexpr auto kCell = static_cast<Eigen::Index>(simd::kCellPoints);
  const auto cells = static_cast<Eigen::Index>(order.size()) / kCell;
  const auto padded = simd::whole_vectors(static_cast<std::size_t>(cells), simd::kSimdPadFloat);
  const Eigen::MatrixXf rounded = points(Eigen::all, order).unaryExpr(&simd::nearest_float);
  points_.resize(kCell, points.rows() * cells);
  low_ = high_ = Eigen::MatrixXf::Constant(static_cast<Eigen::Index>(padded), points.rows(),
                                           std::numeric_limits<float>::infinity());
  for (Eigen::Index c = 0; c < cells; ++c) {
    const auto cell = rounded.middleCols(c * kCell, kCell);
    points_.middleCols(c * points.rows(), points.rows()) = cell.transpose();
    low_.row(c) = cell.rowwise().minCoeff().transpose();
    high_.row(c) = cell.rowwise().maxCoeff().transpose();
  }
  nearest_ = simd::loops(static_cast<int>(points.rows())).nearest;
}

double NearestDistance::squared(const double* x, float enough) const noexcept {
  // Beyond this a squared distance is no finite float, and no cell would be the nearest.
  for (std::size_t k = 0; k < dimension_; ++k)
    if (!(std::abs(x[k]) < 1e19)) return std::numeric_limits<double>::infinity();
  const simd::Cells cells{points_.data(), low_.data(), high_.data(), static_cast<std::size_t>(low_.rows())};
  const std::uint32_t last = last_cell_.load(std::memory_order_relaxed);
  std::uint32_t cell = last;
  const float squared = nearest_(cells, x, enough, cell);
  if (cell != last) last_cell_.store(cell, std::memory_order_relaxed);
  return squared <= enough ? 0.0 : static_cast<double>(squared);
}

DomainGuard::DomainGuard(const DomainCover& cover)
    : inner_radius_(cover.inner_radius),
      outer_radius_(cover.outer_radius),
      near_squared_(std::nextafter(static_cast<float>(cover.inner_radius * cover.inner_radius), 0.0F)),
      points_(cover.points) {}

double DomainGuard::trust_at(double squared) const noexcept {
  if (squared <= inner_radius_ * inner_radius_) return 1.0;
  return trust_at_distance(std::sqrt(squared), inner_radius_, outer_radius_);
}

double trust_at_distance(double distance, double inner_radius, double outer_radius) noexcept {
  if (!(distance < outer_radius)) return 0.0;
  if (distance <= inner_radius) return 1.0;
  const double t = (outer_radius - distance) / (outer_radius - inner_radius);
  return t * t * (3.0 - 2.0 * t);
}

namespace {

// A press deeper than the deepest recorded one by this share is out of the domain, whatever the radius of the guard: a
// ball on a soft solid (Hertz 1881, 1.15^1.5 = 1.23) has then reached kForceMargin.
constexpr double kDeeper = 0.15;
// A part of the force above this multiple of the largest forces in the file indicates a damaged number: the model would
// jump between 0 and its limit. The parts of a fitted model are far smaller.
constexpr double kMostOfLimit = 100.0;

}  // namespace

double Normalisation::range(Eigen::Index feature) const {
  const double low = lower(feature), high = upper(feature);
  return high - low > 1e-12 * std::max(std::abs(low), std::abs(high)) ? high - low : 0.0;
}

Eigen::VectorXd Normalisation::scale_of(double range_exponent) const {
  Eigen::VectorXd other = scale;
  for (Eigen::Index k = 0; k < other.size(); ++k)
    if (range(k) > 0.0) other(k) = range(k) * std::pow(scale(k) / range(k), 2.0 * (1.0 - range_exponent));
  return other;
}

Status check_forces(const ModelData& data) {
  const double limit_N = kMostOfLimit * (data.largest_force_N + data.correction_limit_N + data.jnd.offset_N);
  const TrendInputs inputs(data.features);
  std::array<double, kMaxFeatures> features{};
  for (Eigen::Index j = 0; j < data.cover.points.cols(); ++j) {
    const auto u = data.cover.points.col(j);
    for (Eigen::Index i = 0; i < u.size(); ++i)
      features[static_cast<std::size_t>(i)] = data.offset(i) + data.scale(i) * u(i);
    const double correction_N = data.correction ? data.correction->evaluate(u.data()) : 0.0;
    for (const auto& [part_N, name] :
         {std::pair{data.trend.at(features.data(), inputs), "trend"}, std::pair{correction_N, "correction"}}) {
      if (std::abs(part_N) <= limit_N) continue;
      return Error{std::string(name) + ": found " + general(part_N, 3) + " N at domain.points[" + std::to_string(j) +
                   "], expected at most " + general(limit_N, 4) +
                   " N, a hundred times the sum of largest_force_N, correction_limit_N and the JND"};
    }
  }
  return {};
}

SensorSpec sensor_with_step(const ModelData& data, double encoder_step_m) {
  const bool theirs = data.sensor && (encoder_step_m == 0.0 || encoder_step_m == data.sensor->encoder_step_m);
  return theirs ? *data.sensor : SensorSpec{encoder_step_m, 0.0};
}

std::string began_words(const ModelData& data, int began) {
  if (began == kBeganAtRest) return "at rest";
  if (began == kBeganAsTold) return "as the end of the recording before";
  const auto index = static_cast<std::size_t>(began);
  const std::vector<std::string>& names = data.provenance.recordings;
  return "as the end of " + (index < names.size() ? names[index] : "training recording " + std::to_string(began + 1));
}

FittedModel::FittedModel(ModelData data)
    : data_(std::move(data)), trend_inputs_(data_.features), guard_(data_.cover), dimension_(data_.features.size()) {
  for (std::size_t i = 0; i < dimension_; ++i) {
    offset_[i] = data_.offset(static_cast<Eigen::Index>(i));
    inverse_scale_[i] = 1.0 / data_.scale(static_cast<Eigen::Index>(i));
  }
  if (trend_inputs_.depth != TrendInputs::kNone) {
    depth_ = trend_inputs_.depth;
    const double lower_m = data_.lower(trend_inputs_.depth), upper_m = data_.upper(trend_inputs_.depth);
    deepest_m_ = upper_m + kDeeper * (upper_m - lower_m);
    if (data_.surface_step_N > 0.0) shallowest_m_ = std::max(lower_m, std::numeric_limits<double>::min());
  }
  trusts_everywhere_ = data_.cover.inner_radius >= kEverywhere;
}

double FittedModel::force(const double* features) const noexcept {
  double force_N = data_.trend.at(features, trend_inputs_);
  if (data_.correction) {
    const std::array<double, kMaxFeatures> u = normalised(features);
    const double trust = trusts_everywhere_ ? 1.0 : guard_.trust(u.data());
    if (trust > 0.0) {
      const double correction_N = data_.correction->evaluate(u.data());
      force_N += trust * std::clamp(correction_N, -data_.correction_limit_N, data_.correction_limit_N);
    }
  }
  // The comparisons are false for NaN, so that the result is always a finite force.
  if (!(force_N > 0.0)) force_N = force_N < 0.0 ? std::max(force_N, data_.lowest_force_N) : 0.0;
  return std::min(force_N, kForceMargin * data_.largest_force_N);
}

void FittedModel::assess(const double* features, ForceEstimate& estimate) const noexcept {
  const bool anywhere = trusts_everywhere_ && !data_.error_bound;
  const double squared_distance = anywhere ? 0.0 : guard_.squared_distance(normalised(features).data());
  estimate.out_of_domain = guard_.trust_at(squared_distance) < 0.5 || features[depth_] > deepest_m_;
  if (!data_.error_bound) return;
  const double beyond = std::sqrt(squared_distance) - data_.cover.inner_radius;
  estimate.predicted_error_N = data_.error_bound->at(estimate.force_N, beyond) +
                               data_.trend.moved_N(features[depth_], data_.error_bound->surface_error_m);
}

}  // namespace palpate
