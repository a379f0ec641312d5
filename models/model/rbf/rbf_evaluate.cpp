#include "models/model/rbf/rbf_evaluate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

#include "engine/base/parallel.h"

namespace palpate {
namespace {

constexpr std::align_val_t kAlignment{64};

// Zeroed, aligned to a cache line and to the widest vector.
template <typename T>
std::shared_ptr<T[]> aligned_array(std::size_t count) {
  void* memory = ::operator new[](std::max<std::size_t>(1, count) * sizeof(T), kAlignment);
  T* first = static_cast<T*>(memory);
  std::uninitialized_value_construct_n(first, count);
  return std::shared_ptr<T[]>(first, [](T* p) { ::operator delete[](static_cast<void*>(p), kAlignment); });
}

std::size_t round_up(Eigen::Index count, std::size_t multiple) {
  return (static_cast<std::size_t>(count) + multiple - 1) / multiple * multiple;
}

// Two floats that differ and are both 0 or at least this differ by 1e-18 or
// more, so that their squared distance is not denormal.
constexpr double kTinyFloat = 1e-11;

// A leaf of the nearest point's tree has so many of the widest vector at least, and
// less than twice as many: on recordings 1 in 25 queries needs more than its leaf.
constexpr std::size_t kBlocksOfLeaf = 2;

float to_float(double value) { return std::abs(value) < kTinyFloat ? 0.0F : static_cast<float>(value); }

}  // namespace

PointArrays::PointArrays(const Eigen::MatrixXd& points) : count_(points.cols()) {
  assert(points.rows() >= 1 && points.rows() <= static_cast<Eigen::Index>(kMaxFeatures));
  view_.dimension = static_cast<int>(points.rows());
  view_.padded = round_up(points.cols(), simd::kSimdPad);
  // An odd number of cache lines between rows, so that the same index of
  // different rows does not fall into the same cache set.
  view_.stride = view_.padded + (view_.padded / simd::kSimdPad % 2 == 0 ? simd::kSimdPad : 0);
  auto memory = aligned_array<double>(view_.stride * static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      memory[static_cast<std::ptrdiff_t>(view_.stride) * k + i] = simd::without_denormals(points(k, i));
  if (points.size() > 0) view_.largest = points.cwiseAbs().maxCoeff();
  view_.coordinates = memory.get();
  memory_ = std::move(memory);
}

RbfEvaluator::RbfEvaluator(const RbfFunction& function)
    : centres_(function.centres),
      tail_(function.tail.begin(), function.tail.end()),
      dimension_(function.dimension()),
      evaluate_(simd::evaluate_function(function.kernel, function.dimension())) {
  assert(validate_rbf_function(function).ok());
  auto weights = aligned_array<double>(centres_.view().padded);
  for (Eigen::Index j = 0; j < function.weights.size(); ++j) weights[j] = simd::without_denormals(function.weights[j]);
  weights_ = std::move(weights);
}

void RbfEvaluator::evaluate_many(const Eigen::MatrixXd& points, Eigen::VectorXd& out) const {
  assert(points.rows() == dimension_);
  out.resize(points.cols());
  // A part of about 1e6 kernels takes half a millisecond: worth a thread.
  const Eigen::Index chunk = std::max<Eigen::Index>(1, 1000000 / std::max<Eigen::Index>(1, centre_count()));
  const auto parts = static_cast<int>((points.cols() + chunk - 1) / chunk);
  parallel_for(parts, [&](int part) {
    const Eigen::Index end = std::min(points.cols(), (part + 1) * chunk);
    for (Eigen::Index i = part * chunk; i < end; ++i) out[i] = evaluate(points.col(i).data());
  });
}

void kernel_matrix(KernelKind kind, const PointArrays& points, const Eigen::Ref<const Eigen::MatrixXd>& centres,
                   Eigen::Ref<Eigen::MatrixXd> out, Eigen::Index first_row) {
  assert(first_row % static_cast<Eigen::Index>(simd::kSimdPad) == 0);
  assert(first_row + out.rows() <= points.count() && out.cols() == centres.cols());
  const simd::ColumnFunction column = simd::column_function(kind, points.view().dimension);
  simd::Points rows = points.view();
  rows.coordinates += first_row;
  for (Eigen::Index j = 0; j < centres.cols(); ++j)
    column(rows, static_cast<std::size_t>(out.rows()), centres.col(j).data(), out.col(j).data());
}

KernelProduct::KernelProduct(KernelKind kind, const PointArrays& points)
    : points_(points), product_(simd::product_function(kind, points.view().dimension)) {}

Eigen::VectorXd KernelProduct::multiply(const Eigen::VectorXd& v) const {
  // Tiles of the lower triangle; a tile's rows, columns and vectors fit in the
  // first-level cache.
  constexpr std::size_t kTile = 256;
  // Each part sums into a vector of its own; their number is fixed so that the
  // order of the sum is too.
  constexpr int kParts = 8;
  const std::size_t padded = points_.view().padded;
  const std::size_t tiles = (padded + kTile - 1) / kTile;
  const auto input = aligned_array<double>(padded);
  std::copy(v.begin(), v.end(), input.get());
  const auto sums = aligned_array<double>(padded * kParts);
  parallel_for(kParts, [&](int part) {
    double* y = sums.get() + padded * static_cast<std::size_t>(part);
    std::size_t index = 0;
    for (std::size_t row = 0; row < tiles; ++row)
      for (std::size_t column = 0; column <= row; ++column)
        if (index++ % kParts == static_cast<std::size_t>(part))
          product_(points_.view(), row * kTile, std::min(padded, (row + 1) * kTile), column * kTile,
                   std::min(padded, (column + 1) * kTile), input.get(), y);
  });
  Eigen::VectorXd result = Eigen::VectorXd::Zero(v.size());
  for (int part = 0; part < kParts; ++part)
    result += Eigen::Map<const Eigen::VectorXd>(sums.get() + padded * static_cast<std::size_t>(part), v.size());
  return result;
}

NearestDistance::NearestDistance(const Eigen::MatrixXd& points)
    : stride_(round_up(points.cols(), simd::kSimdPadFloat)),
      dimension_(static_cast<int>(points.rows())),
      nearest_(simd::nearest_function(dimension_)) {
  assert(points.cols() >= 1);
  const std::size_t blocks = stride_ / simd::kSimdPadFloat;
  std::size_t leaves = 1;
  while (blocks / (2 * leaves) >= kBlocksOfLeaf) leaves *= 2;
  splits_.resize(leaves - 1);
  leaf_begin_.assign(leaves + 1, stride_);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  split(points, order, 0, 0, blocks);
  order.resize(stride_, order.back());  // padded with copies of the last point
  auto memory = aligned_array<float>(stride_ * static_cast<std::size_t>(points.rows()));
  for (std::size_t i = 0; i < stride_; ++i)
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      memory[static_cast<std::ptrdiff_t>(stride_ * static_cast<std::size_t>(k) + i)] = to_float(points(k, order[i]));
  memory_ = std::move(memory);
}

// Sorts the points of a node, which has whole blocks of the widest vector, into two
// halves at the median of their widest dimension, and these likewise.
void NearestDistance::split(const Eigen::MatrixXd& points, std::vector<Eigen::Index>& order, std::size_t node,
                            std::size_t first_block, std::size_t last_block) {
  if (node >= splits_.size()) {
    leaf_begin_[node - splits_.size()] = first_block * simd::kSimdPadFloat;
    return;
  }
  const std::size_t middle_block = (first_block + last_block) / 2;
  const auto place = [&](std::size_t block) {
    return order.begin() + static_cast<std::ptrdiff_t>(std::min(block * simd::kSimdPadFloat, order.size()));
  };
  const auto first = place(first_block);
  const auto middle = place(middle_block);
  const auto last = place(last_block);
  Eigen::Index widest = 0;
  double width = -1.0;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const auto [low, high] = std::minmax_element(
        first, last, [&](Eigen::Index a, Eigen::Index b) { return points(k, a) < points(k, b); });
    if (points(k, *high) - points(k, *low) > width) {
      width = points(k, *high) - points(k, *low);
      widest = k;
    }
  }
  std::nth_element(first, middle, last, [&](Eigen::Index a, Eigen::Index b) {
    return points(widest, a) != points(widest, b) ? points(widest, a) < points(widest, b) : a < b;
  });
  splits_[node] = {static_cast<int>(widest), to_float(points(widest, *middle))};
  split(points, order, 2 * node + 1, first_block, middle_block);
  split(points, order, 2 * node + 2, middle_block, last_block);
}

double NearestDistance::nearest_squared(const double* x, double enough) const noexcept {
  constexpr double kFarthest = 1e19;  // its square is the last that fits a float
  std::array<float, kMaxFeatures> query;
  for (int k = 0; k < dimension_; ++k) {
    if (!(std::abs(x[k]) < kFarthest)) return std::numeric_limits<double>::infinity();
    query[static_cast<std::size_t>(k)] = to_float(x[k]);
  }
  if (enough >= 0.0) {
    std::size_t node = 0;
    while (node < splits_.size()) {
      const Split& split = splits_[node];
      node = 2 * node + 1 + (query[static_cast<std::size_t>(split.dimension)] >= split.value ? 1 : 0);
    }
    const std::size_t leaf = node - splits_.size();
    const float of_leaf = nearest_(memory_.get() + leaf_begin_[leaf], stride_,
                                   leaf_begin_[leaf + 1] - leaf_begin_[leaf], query.data());
    if (static_cast<double>(of_leaf) <= enough) return static_cast<double>(of_leaf);
  }
  const float squared = nearest_(memory_.get(), stride_, stride_, query.data());
  return squared < std::numeric_limits<float>::max() ? static_cast<double>(squared)
                                                     : std::numeric_limits<double>::infinity();
}

}  // namespace palpate
