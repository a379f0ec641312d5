#include "models/model/nearest_points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/tick/features.h"
#include "models/model/aligned_array.h"

namespace palpate {
namespace {

// The share of a part that each of its halves has of the other.
constexpr double kOverlap = 0.1;

std::size_t whole_vectors(std::size_t count) {
  return (count + simd::kSimdPadFloat - 1) / simd::kSimdPadFloat * simd::kSimdPadFloat;
}

// The points `order`, and the last again up to `stride`; one row a coordinate.
void fill_rows(const Eigen::MatrixXd& points, const std::vector<Eigen::Index>& order, std::size_t stride, float* to) {
  for (Eigen::Index k = 0; k < points.rows(); ++k)
    for (std::size_t i = 0; i < stride; ++i) *to++ = simd::nearest_float(points(k, order[std::min(i, order.size() - 1)]));
}

std::vector<Eigen::Index> all_of(const Eigen::MatrixXd& points) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(points.cols()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Eigen::Index>(i);
  return all;
}

Eigen::Index widest_dimension(const Eigen::MatrixXd& points, const std::vector<Eigen::Index>& part) {
  Eigen::Index widest = 0;
  double width = -1.0;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const auto [low, high] = std::minmax_element(
        part.begin(), part.end(), [&](Eigen::Index a, Eigen::Index b) { return points(k, a) < points(k, b); });
    if (points(k, *high) - points(k, *low) <= width) continue;
    width = points(k, *high) - points(k, *low);
    widest = k;
  }
  return widest;
}

}  // namespace

NearestDistance::NearestDistance(const Eigen::MatrixXd& points)
    : stride_(whole_vectors(static_cast<std::size_t>(points.cols()))),
      dimension_(static_cast<int>(points.rows())),
      nearest_(simd::nearest_function(dimension_)) {
  assert(points.cols() >= 1);
  auto memory = aligned_array<float>(stride_ * static_cast<std::size_t>(points.rows()));
  fill_rows(points, all_of(points), stride_, memory.get());
  memory_ = std::move(memory);
}

double NearestDistance::nearest_squared(const double* x) const noexcept {
  std::array<float, kMaxFeatures> query;
  for (int k = 0; k < dimension_; ++k) {
    if (!simd::in_nearest_range(x[k])) return std::numeric_limits<double>::infinity();
    query[static_cast<std::size_t>(k)] = simd::nearest_float(x[k]);
  }
  const float squared = nearest_(memory_.get(), stride_, stride_, query.data());
  return squared < std::numeric_limits<float>::max() ? static_cast<double>(squared)
                                                     : std::numeric_limits<double>::infinity();
}

NearPoints::NearPoints(const Eigen::MatrixXd& points, double radius)
    : radius_squared_(static_cast<float>(radius * radius)),
      near_(simd::near_function(static_cast<int>(points.rows()))) {
  // Not above what the distance is compared with.
  if (static_cast<double>(radius_squared_) > radius * radius) radius_squared_ = std::nextafter(radius_squared_, 0.0F);
  const auto rows = static_cast<std::size_t>(points.rows());
  splits_ = aligned_array<float>(simd::kNearLeaves * rows);
  std::fill_n(splits_.get(), simd::kNearLeaves * rows, std::numeric_limits<float>::infinity());
  std::vector<std::vector<Eigen::Index>> leaves(simd::kNearLeaves);
  split(points, all_of(points), 0, leaves);
  for (const auto& leaf : leaves) leaf_size_ = std::max(leaf_size_, whole_vectors(leaf.size()));
  leaves_ = aligned_array<float>(simd::kNearLeaves * leaf_size_ * rows);
  for (std::size_t i = 0; i < leaves.size(); ++i)
    fill_rows(points, leaves[i], leaf_size_, leaves_.get() + i * leaf_size_ * rows);
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
  splits_[static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * simd::kNearLeaves + node)] =
      simd::nearest_float(points(k, part[middle]));
  const auto place = [&](std::size_t i) { return part.begin() + static_cast<std::ptrdiff_t>(i); };
  split(points, {part.begin(), place(std::max<std::size_t>(1, middle + overlap))}, 2 * node + 1, leaves);
  split(points, {place(middle - overlap), part.end()}, 2 * node + 2, leaves);
}

}  // namespace palpate
