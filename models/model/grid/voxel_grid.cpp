#include "models/model/grid/voxel_grid.h"

#include <algorithm>

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

VoxelLookup::VoxelLookup(const VoxelGrid& grid)
    : values_(grid.values_N), interpolate_(pick(static_cast<int>(grid.nodes.size()))) {
  std::size_t stride = 1;
  for (std::size_t k = grid.nodes.size(); k-- > 0; stride *= grid.nodes[k].size()) {
    const std::vector<double>& nodes = grid.nodes[k];
    axes_[k] = {nodes, {}, stride};
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      axes_[k].reciprocal_width.push_back(1.0 / (nodes[i + 1] - nodes[i]));
    }
  }
}

VoxelLookup::Cell VoxelLookup::locate(const Axis& axis, double x) noexcept {
  const std::vector<double>& nodes = axis.nodes;
  const double inside = x > nodes.front() ? std::min(x, nodes.back()) : nodes.front();  // NaN: the lower edge
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, inside);
  const auto cell = static_cast<std::size_t>(above - nodes.begin()) - 1;
  return {cell * axis.stride, (inside - nodes[cell]) * axis.reciprocal_width[cell]};
}

template <int kDimension>
double VoxelLookup::interpolate(const double* x) const noexcept {
  std::array<double, kDimension> fraction;
  std::array<std::size_t, kDimension> stride;
  const double* corner = values_.data();
  for (std::size_t k = 0; k < kDimension; ++k) {
    const Cell cell = locate(axes_[k], x[k]);
    corner += cell.offset;
    fraction[k] = cell.fraction;
    stride[k] = axes_[k].stride;
  }
  const Eigen::Array2d ends = between<0, kDimension>(corner, stride.data(), fraction.data());
  return ends[0] + fraction[kDimension - 1] * (ends[1] - ends[0]);
}

VoxelLookup::Interpolate VoxelLookup::pick(int dimension) {
  static constexpr Interpolate kTable[] = {&VoxelLookup::interpolate<1>, &VoxelLookup::interpolate<2>,
                                           &VoxelLookup::interpolate<3>, &VoxelLookup::interpolate<4>,
                                           &VoxelLookup::interpolate<5>, &VoxelLookup::interpolate<6>,
                                           &VoxelLookup::interpolate<7>, &VoxelLookup::interpolate<8>};
  return kTable[dimension - 1];
}

}  // namespace palpate
