#include "models/model/domain_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

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
  // Every site has full trust, however much the cover was thinned.
  cover.inner_radius = std::max(kInnerRadius, 1.5 * radius);
  cover.outer_radius = kOuterToInner * cover.inner_radius;
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
  std::array<float, kMaxFeatures> query;
  bool in_range = true;
  for (std::size_t k = 0; k < dimension_; ++k) {
    in_range = in_range && simd::in_nearest_range(x[k]);
    query[k] = simd::nearest_float(x[k]);
  }
  if (!in_range) return std::numeric_limits<double>::infinity();
  const simd::Cells cells{points_.data(), low_.data(), high_.data(), static_cast<std::size_t>(low_.rows())};
  const std::uint32_t last = last_cell_.load(std::memory_order_relaxed);
  std::uint32_t cell = last;
  const float squared = nearest_(cells, query.data(), enough, cell);
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

}  // namespace palpate
