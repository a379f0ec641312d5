#include "models/model/domain_guard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {
namespace {

// Radii in the normalised feature space, where a feature's spread is about 1.
// On held-out recordings of six materials the correction is better than the
// trend up to about 0.2 from the data and worse beyond; see tests/models.
constexpr double kInnerRadius = 0.08;
constexpr double kOuterToInner = 3.0;
constexpr double kFirstCoverRadius = 0.03;
constexpr double kCoverGrowth = 1.25;

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

// The share of a part by which its halves overlap.
constexpr double kOverlap = 0.1;
// The rounding of a distance relative to the norms of query and points.
constexpr double kDistanceRounding = 3e-7;

std::size_t whole_vectors(std::size_t count) {
  return (count + simd::kSimdPadFloat - 1) / simd::kSimdPadFloat * simd::kSimdPadFloat;
}

// The points `order`, one column for each coordinate; the last point is repeated up to `stride`.
Eigen::MatrixXf padded(const Eigen::MatrixXd& points, std::vector<Eigen::Index> order, std::size_t stride) {
  order.resize(stride, order.back());
  return points(Eigen::all, order).transpose().unaryExpr(&simd::nearest_float);
}

std::vector<Eigen::Index> all_of(const Eigen::MatrixXd& points) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(points.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return all;
}

Eigen::Index widest_dimension(const Eigen::MatrixXd& points, const std::vector<Eigen::Index>& part) {
  const Eigen::MatrixXd some = points(Eigen::all, part);
  Eigen::Index widest = 0;
  (some.rowwise().maxCoeff() - some.rowwise().minCoeff()).maxCoeff(&widest);
  return widest;
}

}  // namespace

DomainCover make_cover(const Eigen::MatrixXd& sites) {
  double radius = kFirstCoverRadius;
  std::vector<Eigen::Index> kept;
  while ((kept = thinned(sites, radius)).empty()) radius *= kCoverGrowth;
  DomainCover cover;
  cover.points = sites(Eigen::all, kept);
  // Every site has full trust, however much the cover was thinned.
  cover.inner_radius = std::max(kInnerRadius, 1.5 * radius);
  cover.outer_radius = kOuterToInner * cover.inner_radius;
  return cover;
}

NearestDistance::NearestDistance(const Eigen::MatrixXd& points)
    : rows_(padded(points, all_of(points), whole_vectors(static_cast<std::size_t>(points.cols())))),
      nearest_(simd::nearest_loops(static_cast<int>(points.rows())).nearest) {}

double NearestDistance::nearest_squared(const double* x) const noexcept {
  std::array<float, kMaxFeatures> query;
  for (Eigen::Index k = 0; k < rows_.cols(); ++k) {
    if (!simd::in_nearest_range(x[k])) return std::numeric_limits<double>::infinity();
    query[static_cast<std::size_t>(k)] = simd::nearest_float(x[k]);
  }
  const float squared = nearest_(rows_.data(), static_cast<std::size_t>(rows_.rows()), query.data());
  return squared < std::numeric_limits<float>::max() ? static_cast<double>(squared)
                                                     : std::numeric_limits<double>::infinity();
}

NearPoints::NearPoints(const Eigen::MatrixXd& points, double radius)
    : loops_(simd::nearest_loops(static_cast<int>(points.rows()))) {
  const Eigen::VectorXd centre = 0.5 * (points.rowwise().minCoeff() + points.rowwise().maxCoeff());
  const Eigen::MatrixXd about = points.colwise() - centre;
  std::copy(centre.begin(), centre.end(), tree_.centre.begin());
  tree_.split_at.fill(std::numeric_limits<float>::infinity());
  std::vector<std::vector<Eigen::Index>> leaves(simd::kNearLeaves);
  split(about, all_of(about), 0, leaves);
  for (const auto& leaf : leaves) tree_.leaf_size = std::max(tree_.leaf_size, whole_vectors(leaf.size()));

  Eigen::MatrixXd rows(points.rows() + 1, points.cols());
  rows << about, -0.5 * about.colwise().squaredNorm();
  const auto floats = static_cast<Eigen::Index>(tree_.leaf_size) * rows.rows();
  Eigen::MatrixXf memory(floats, static_cast<Eigen::Index>(leaves.size()));
  for (std::size_t i = 0; i < leaves.size(); ++i)
    memory.col(static_cast<Eigen::Index>(i)) = padded(rows, leaves[i], tree_.leaf_size).reshaped();
  leaves_ = std::make_shared<const Eigen::MatrixXf>(std::move(memory));
  tree_.leaves = leaves_->data();
  set_limit(radius, points.colwise().norm().maxCoeff(), about.colwise().squaredNorm().maxCoeff());
}

// With u = 2^-24, P the largest |p| and Q = |q|, the rounding of q, of p, of a product and a sum for each of up to 8
// coordinates and of the limit is less than 18 u (P^2 + Q^2) = 1.1e-6 (P^2 + Q^2), and 1e-10 for values set to 0.
void NearPoints::set_limit(double radius, double largest, double about_squared) {
  constexpr double kRounding = 2e-6;
  const double certain = radius - kDistanceRounding * (2.0 * largest + radius) - 1e-9;
  const double half_squared = 0.5 * certain * certain - kRounding * about_squared - 1e-10;
  tree_.half = static_cast<float>(0.5 + kRounding);
  tree_.half_squared = certain > 0.0 && half_squared < std::numeric_limits<float>::max()
                           ? static_cast<float>(half_squared)
                           : -std::numeric_limits<float>::infinity();
}

void NearPoints::split(const Eigen::MatrixXd& points, std::vector<Eigen::Index> part, std::size_t node,
                       std::vector<std::vector<Eigen::Index>>& leaves) {
  if (node + 1 >= simd::kNearLeaves) {
    leaves[node + 1 - simd::kNearLeaves] = std::move(part);
    return;
  }
  const Eigen::Index k = widest_dimension(points, part);
  std::sort(part.begin(), part.end(), [&](Eigen::Index a, Eigen::Index b) {
    return points(k, a) != points(k, b) ? points(k, a) < points(k, b) : a < b;
  });
  const std::size_t middle = part.size() / 2;
  const auto overlap = static_cast<std::size_t>(kOverlap * static_cast<double>(part.size()));
  tree_.split_coordinate[node] = static_cast<std::int32_t>(k);
  tree_.split_at[node] = simd::nearest_float(points(k, part[middle]));
  const auto place = [&](std::size_t i) { return part.begin() + static_cast<std::ptrdiff_t>(i); };
  split(points, {part.begin(), place(std::max<std::size_t>(1, middle + overlap))}, 2 * node + 1, leaves);
  split(points, {place(middle - overlap), part.end()}, 2 * node + 2, leaves);
}

DomainGuard::DomainGuard(const DomainCover& cover)
    : inner_radius_(cover.inner_radius),
      outer_radius_(cover.outer_radius),
      near_(cover.points, cover.inner_radius),
      nearest_(cover.points) {}

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

}  // namespace palpate
