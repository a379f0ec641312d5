#include "models/model/grid/voxel_grid.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace palpate {
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

GridCorrection::GridCorrection(VoxelGrid grid) : grid_(std::move(grid)), interpolate_(pick(grid_.nodes.size())) {
  std::size_t stride = 1;
  for (std::size_t k = grid_.nodes.size(); k-- > 0; stride *= grid_.nodes[k].size()) {
    const std::vector<double>& nodes = grid_.nodes[k];
    axes_[k] = {nodes, {}, stride};
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
      axes_[k].reciprocal_width.push_back(1.0 / (nodes[i + 1] - nodes[i]));
  }
}

GridCorrection::Cell GridCorrection::locate(const Axis& axis, double x) noexcept {
  const std::span<const double> nodes = axis.nodes;
  const double inside = x > nodes.front() ? std::min(x, nodes.back()) : nodes.front();  // NaN: the lower edge
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, inside);
  const auto cell = static_cast<std::size_t>(above - nodes.begin()) - 1;
  return {cell * axis.stride, (inside - nodes[cell]) * axis.reciprocal_width[cell]};
}

template <int kDimension>
double GridCorrection::interpolate(const double* x) const noexcept {
  std::array<double, kDimension> fraction;
  std::array<std::size_t, kDimension> stride;
  const double* corner = grid_.values_N.data();
  for (std::size_t k = 0; k < kDimension; ++k) {
    const Cell cell = locate(axes_[k], x[k]);
    corner += cell.offset;
    fraction[k] = cell.fraction;
    stride[k] = axes_[k].stride;
  }
  const Eigen::Array2d ends = between<0, kDimension>(corner, stride.data(), fraction.data());
  return ends[0] + fraction[kDimension - 1] * (ends[1] - ends[0]);
}

GridCorrection::Interpolate GridCorrection::pick(std::size_t dimension) {
  static constexpr Interpolate kTable[] = {&GridCorrection::interpolate<1>, &GridCorrection::interpolate<2>,
                                           &GridCorrection::interpolate<3>, &GridCorrection::interpolate<4>,
                                           &GridCorrection::interpolate<5>, &GridCorrection::interpolate<6>,
                                           &GridCorrection::interpolate<7>, &GridCorrection::interpolate<8>};
  return kTable[dimension - 1];
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

const VoxelGrid* grid_of(const CorrectionPtr& correction) {
  const auto* grid = dynamic_cast<const GridCorrection*>(correction.get());
  return grid == nullptr ? nullptr : &grid->grid();
}

}  // namespace palpate
