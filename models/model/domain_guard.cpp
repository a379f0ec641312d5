#include "models/model/domain_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace palpate {
namespace {

// Radii in the normalised feature space, where a feature's spread is about 1. The inner one is the smallest of those
// that a fit selects from (models/fit/residual_rows.h). On held-out recordings of six materials a correction is
// better than the trend up to about 0.2 from the data and worse beyond.
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

// The share of a part by which its halves overlap. Of a thousand queries with a near point, 1 to 6 then miss it in
// their leaf (14 with six features), instead of 28 to 200 without.
constexpr double kOverlap = 0.1;

std::vector<Eigen::Index> all_of(const Eigen::MatrixXd& points) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(points.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return all;
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

NearestDistance::NearestDistance(const Eigen::MatrixXd& points) : loops_(simd::loops(static_cast<int>(points.rows()))) {
  std::vector<Eigen::Index> order = all_of(points);
  order.resize(simd::whole_vectors(order.size(), simd::kSimdPadFloat), order.back());
  rows_ = points(Eigen::all, order).transpose().unaryExpr(&simd::nearest_float);
}

double NearestDistance::nearest_squared(const double* x) const noexcept {
  std::array<float, kMaxFeatures> query;
  for (Eigen::Index k = 0; k < rows_.cols(); ++k) {
    if (!simd::in_nearest_range(x[k])) return std::numeric_limits<double>::infinity();
    query[static_cast<std::size_t>(k)] = simd::nearest_float(x[k]);
  }
  return static_cast<double>(loops_.nearest(rows_.data(), static_cast<std::size_t>(rows_.rows()), query.data()));
}

DomainGuard::DomainGuard(const DomainCover& cover)
    : inner_radius_(cover.inner_radius),
      outer_radius_(cover.outer_radius),
      near_squared_(std::nextafter(static_cast<float>(cover.inner_radius * cover.inner_radius), 0.0F)),
      all_(cover.points),
      leaf_(simd::loops(static_cast<int>(cover.points.rows())).leaf) {
  split(cover.points, all_of(cover.points), 0);
}

void DomainGuard::split(const Eigen::MatrixXd& points, std::vector<Eigen::Index> part, std::size_t node) {
  if (node + 1 >= simd::kLeaves) {
    leaves_.emplace_back(points(Eigen::all, part));
    return;
  }
  const Eigen::MatrixXd some = points(Eigen::all, part);
  Eigen::Index k = 0;  // the widest dimension
  (some.rowwise().maxCoeff() - some.rowwise().minCoeff()).maxCoeff(&k);
  std::sort(part.begin(), part.end(), [&](Eigen::Index a, Eigen::Index b) {
    return points(k, a) != points(k, b) ? points(k, a) < points(k, b) : a < b;
  });
  const std::size_t middle = part.size() / 2;
  const auto overlap = static_cast<std::size_t>(kOverlap * static_cast<double>(part.size()));
  splits_.coordinate[node] = static_cast<std::int32_t>(k);
  splits_.at[node] = simd::nearest_float(points(k, part[middle]));
  const auto place = [&](std::size_t i) { return part.begin() + static_cast<std::ptrdiff_t>(i); };
  split(points, {part.begin(), place(std::max<std::size_t>(1, middle + overlap))}, 2 * node + 1);
  split(points, {place(middle - overlap), part.end()}, 2 * node + 2);
}

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
