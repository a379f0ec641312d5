#include "models/model/correction.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace palpate {

PointArrays::PointArrays(const Eigen::MatrixXd& points) : count_(points.cols()) {
  assert(points.rows() >= 1 && points.rows() <= static_cast<Eigen::Index>(kMaxFeatures));
  view_.dimension = static_cast<int>(points.rows());
  view_.padded = simd::whole_vectors(static_cast<std::size_t>(count_), simd::kSimdPad);
  // An odd number of cache lines between rows, so that the same index of different rows does not fall into the same
  // cache set.
  view_.stride = view_.padded + (view_.padded / simd::kSimdPad % 2 == 0 ? simd::kSimdPad : 0);
  Eigen::MatrixXd memory = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(view_.stride), points.rows());
  memory.topRows(count_) = points.transpose().unaryExpr(&simd::without_denormals);
  memory_ = std::make_shared<const Eigen::MatrixXd>(std::move(memory));
  view_.coordinates = memory_->data();
}

RbfCorrection::RbfCorrection(RbfFunction function)
    : function_(std::move(function)),
      centres_(function_.centres),
      evaluate_(simd::loops(function_.dimension(), function_.kernel).evaluate) {
  assert(function_.weights.size() == function_.centre_count());
  assert(function_.tail.size() == tail_size(tail_degree(function_.kernel), function_.dimension()));
  weights_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(centres_.view().padded));
  weights_.head(function_.weights.size()) = function_.weights.unaryExpr(&simd::without_denormals);
}

void RbfCorrection::evaluate_many(const Eigen::MatrixXd& points, Eigen::VectorXd& out) const {
  assert(points.rows() == function_.dimension());
  out.resize(points.cols());
  // A part of about 1e6 kernels takes half a millisecond, enough for a thread.
  const Eigen::Index chunk = std::max<Eigen::Index>(1, 1000000 / std::max<Eigen::Index>(1, function_.centre_count()));
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
  const auto column = simd::loops(points.view().dimension, kind).column;
  simd::Points rows = points.view();
  rows.coordinates += first_row;
  for (Eigen::Index j = 0; j < centres.cols(); ++j)
    column(rows, static_cast<std::size_t>(out.rows()), centres.col(j).data(), out.col(j).data());
}

Eigen::VectorXd kernel_product(KernelKind kind, const Eigen::MatrixXd& points, const Eigen::VectorXd& v) {
  const auto tail = tail_size(tail_degree(kind), static_cast<int>(points.rows()));
  Eigen::VectorXd product;
  RbfCorrection({kind, points, v, Eigen::VectorXd::Zero(tail)}).evaluate_many(points, product);
  return product;
}

Status fill_grid(VoxelGrid& grid, const BatchFunction& function, const FitControl& control) {
  constexpr std::size_t kGridBatch = 8192;
  const std::size_t dimension = grid.nodes.size();
  std::size_t count = 1;
  for (const std::vector<double>& axis : grid.nodes) count *= axis.size();
  grid.values_N.resize(count);
  Eigen::VectorXd out;
  for (std::size_t first = 0; first < count; first += kGridBatch) {
    if (!control.may_continue(static_cast<double>(first) / static_cast<double>(count))) return interrupted();
    const std::size_t batch = std::min(kGridBatch, count - first);
    Eigen::MatrixXd points(static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(batch));
    for (std::size_t i = 0; i < batch; ++i) {
      std::size_t rest = first + i;
      for (std::size_t k = dimension; k-- > 0; rest /= grid.nodes[k].size())
        points(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = grid.nodes[k][rest % grid.nodes[k].size()];
    }
    out.resize(points.cols());
    function(points, out);
    std::copy(out.begin(), out.end(), grid.values_N.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return {};
}

namespace {

// Interpolates between the corners of a cell along all dimensions but the last, for both ends of the last at once,
// which are neighbours in memory. The compiler unrolls the recursion and keeps everything in registers.
template <int kFirst, int kDimension>
inline Eigen::Array2d between(const double* corner, const std::size_t* stride, const double* fraction) noexcept {
  if constexpr (kFirst == kDimension - 1) {
    return Eigen::Map<const Eigen::Array2d>(corner);
  } else {
    const Eigen::Array2d low = between<kFirst + 1, kDimension>(corner, stride, fraction);
    const Eigen::Array2d high = between<kFirst + 1, kDimension>(corner + stride[kFirst], stride, fraction);
    return low + fraction[kFirst] * (high - low);
  }
}

}  // namespace

template <int kDimension>
double GridCorrection::interpolate(const double* x) const noexcept {
  std::array<double, kDimension> fraction;
  const double* corner = grid_.values_N.data();
  for (std::size_t k = 0; k < kDimension; ++k) {
    const std::span<const double> nodes = nodes_[k];
    const double inside = x[k] > nodes.front() ? std::min(x[k], nodes.back()) : nodes.front();  // NaN: the lower edge
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, inside);
    const auto cell = static_cast<std::size_t>(above - nodes.begin()) - 1;
    corner += cell * stride_[k];
    fraction[k] = (inside - nodes[cell]) * reciprocal_width_[k][cell];
  }
  const Eigen::Array2d ends = between<0, kDimension>(corner, stride_.data(), fraction.data());
  return ends[0] + fraction[kDimension - 1] * (ends[1] - ends[0]);
}

GridCorrection::GridCorrection(VoxelGrid grid) : grid_(std::move(grid)) {
  static constexpr decltype(interpolate_) kByDimension[] = {
      &GridCorrection::interpolate<1>, &GridCorrection::interpolate<2>, &GridCorrection::interpolate<3>,
      &GridCorrection::interpolate<4>, &GridCorrection::interpolate<5>, &GridCorrection::interpolate<6>,
      &GridCorrection::interpolate<7>, &GridCorrection::interpolate<8>};
  interpolate_ = kByDimension[grid_.nodes.size() - 1];
  std::size_t stride = 1;
  for (std::size_t k = grid_.nodes.size(); k-- > 0; stride *= grid_.nodes[k].size()) {
    const std::span<const double> nodes = nodes_[k] = grid_.nodes[k];
    stride_[k] = stride;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) reciprocal_width_[k].push_back(1.0 / (nodes[i + 1] - nodes[i]));
  }
}

const RbfFunction* rbf_of(const CorrectionPtr& correction) {
  const auto* rbf = dynamic_cast<const RbfCorrection*>(correction.get());
  return rbf == nullptr ? nullptr : &rbf->function();
}

const VoxelGrid* grid_of(const CorrectionPtr& correction) {
  const auto* grid = dynamic_cast<const GridCorrection*>(correction.get());
  return grid == nullptr ? nullptr : &grid->grid();
}

}  // namespace palpate
