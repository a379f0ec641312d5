#include "models/model/grid/voxel_lookup.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

namespace palpate {
namespace {

// Interpolates between the corners of a cell along all dimensions but the last,
// for both ends of the last at once: they are neighbours in memory. Unrolled by
// the compiler: everything stays in registers.
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
    : values_(grid.values_N),
      interpolate_(pick(static_cast<int>(grid.nodes.size()))),
      dimension_(static_cast<int>(grid.nodes.size())) {
  assert(validate_voxel_grid(grid, dimension_).ok());
  std::size_t stride = 1;
  for (std::size_t k = grid.nodes.size(); k-- > 0; stride *= grid.nodes[k].size())
    axes_[k] = make_axis(grid.nodes[k], stride);
}

VoxelLookup::Axis VoxelLookup::make_axis(const std::vector<double>& nodes, std::size_t stride) {
  constexpr double kMostIntervals = 4096;
  Axis axis;
  axis.low = nodes.front();
  axis.high = nodes.back();
  axis.stride = stride;
  double shortest = axis.high - axis.low;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    shortest = std::min(shortest, nodes[i + 1] - nodes[i]);
    axis.nodes.push_back({nodes[i], 1.0 / (nodes[i + 1] - nodes[i])});
  }
  axis.nodes.push_back({std::numeric_limits<double>::infinity(), 0.0});
  const double extent = axis.high - axis.low;
  const double intervals = std::clamp(std::ceil(extent / shortest), 1.0, kMostIntervals);
  axis.intervals_per_unit = intervals / extent;
  std::size_t cell = 0;
  for (double i = 0; i <= intervals; ++i) {  // one more than needed, for x = high
    const double start = axis.low + i / axis.intervals_per_unit;
    while (cell + 2 < nodes.size() && nodes[cell + 1] <= start) ++cell;
    // Rounding may put x just below `start` into this interval.
    axis.cell_at.push_back(static_cast<std::uint32_t>(cell > 0 && !(nodes[cell] < start) ? cell - 1 : cell));
  }
  return axis;
}

VoxelLookup::Place VoxelLookup::locate(const Axis& axis, double x) noexcept {
  const double inside = x > axis.low ? std::min(x, axis.high) : axis.low;  // NaN: low
  std::size_t cell = axis.cell_at[static_cast<std::size_t>((inside - axis.low) * axis.intervals_per_unit)];
  // One step, without a branch that half of the queries would mispredict; more
  // only where the table is too coarse.
  cell += axis.nodes[cell + 1].at <= inside ? 1 : 0;
  while (axis.nodes[cell + 1].at <= inside) ++cell;
  return {cell * axis.stride, (inside - axis.nodes[cell].at) * axis.nodes[cell].reciprocal_width};
}

template <int kDimension>
double VoxelLookup::interpolate(const double* x) const noexcept {
  std::array<double, kDimension> fraction;
  std::array<std::size_t, kDimension> stride;
  const double* corner = values_.data();
  for (std::size_t k = 0; k < kDimension; ++k) {
    const Place place = locate(axes_[k], x[k]);
    corner += place.offset;
    fraction[k] = place.fraction;
    stride[k] = axes_[k].stride;
  }
  const Eigen::Array2d ends = between<0, kDimension>(corner, stride.data(), fraction.data());
  return ends[0] + fraction[kDimension - 1] * (ends[1] - ends[0]);
}

VoxelLookup::Interpolate VoxelLookup::pick(int dimension) {
  switch (dimension) {
    case 1:
      return &VoxelLookup::interpolate<1>;
    case 2:
      return &VoxelLookup::interpolate<2>;
    case 3:
      return &VoxelLookup::interpolate<3>;
    case 4:
      return &VoxelLookup::interpolate<4>;
    case 5:
      return &VoxelLookup::interpolate<5>;
    case 6:
      return &VoxelLookup::interpolate<6>;
    case 7:
      return &VoxelLookup::interpolate<7>;
    default:
      return &VoxelLookup::interpolate<8>;
  }
}

}  // namespace palpate
