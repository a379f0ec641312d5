// The voxel method: the direct fit's values on a rectilinear grid, in constant time
// per evaluation.
// Source: Hoever & Harders (2009), section 3.
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include "models/correction/methods.h"
#include "models/model/correction.h"

namespace palpate {
namespace {

// The grid of the paper: 25 nodes along the depth, 11 along every other feature. With more features each axis has
// fewer, so that a grid never has more than kMostNodes.
constexpr int kDepthNodes = 25;
constexpr int kOtherNodes = 11;
constexpr double kMostNodes = 2e5;
constexpr int kPositionOnlyNodes = 200;
// The limit for a requested grid and for a model file.
constexpr double kMaximumGridNodes = 1e7;

double node_count(const std::vector<int>& sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), 1.0, [](double product, int n) { return product * n; });
}

std::vector<int> default_grid(std::size_t features) {
  if (features == 1) return {kPositionOnlyNodes};
  std::vector<int> grid(features, kOtherNodes);
  grid[0] = kDepthNodes;
  while (node_count(grid) > kMostNodes && grid.back() > 2) {
    for (std::size_t i = 1; i < features; ++i) --grid[i];
  }
  return grid;
}

// Node coordinates of one axis: the means of even nodes and of quantiles of the data. (After a fast poke most of an
// even axis has no data, and slow motion too few nodes.)
std::vector<double> axis_nodes(const Eigen::VectorXd& values, int count) {
  std::vector<double> sorted(values.data(), values.data() + values.size());
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted.front();
  const double high = sorted.back();
  if (!(high > low)) {
    std::vector<double> flat(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) flat[static_cast<std::size_t>(i)] = low + 0.1 * (i - 0.5 * (count - 1));
    return flat;
  }
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    const double quantile = sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
    const double evenly = low + share * (high - low);
    nodes.push_back(0.5 * evenly + 0.5 * quantile);
  }
  return nodes;
}

Result<FittedCorrection> fit_voxel(const MethodTask& task, const FitControl& control) {
  const Sites& sites = task.sites;
  const auto d = static_cast<std::size_t>(sites.dimension());
  const std::vector<int> sizes = task.grid.empty() ? default_grid(d) : task.grid;
  if (sizes.size() != d) {
    return Error{"the grid has " + std::to_string(sizes.size()) + " sizes, the model has " + std::to_string(d) +
                 " features; give one size per feature, e.g. --grid 25x11x11x11 for four"};
  }
  if (node_count(sizes) > kMaximumGridNodes) {
    char asked[32];
    std::snprintf(asked, sizeof asked, "%.3g", node_count(sizes));
    return Error{"the grid would have " + std::string(asked) + " nodes, at most 1e7 can be saved; give smaller sizes"};
  }
  VoxelGrid grid;
  for (std::size_t k = 0; k < d; ++k) {
    if (sizes[k] < 2)
      return Error{"a grid needs at least 2 nodes along every feature, found " + std::to_string(sizes[k])};
    grid.nodes.push_back(axis_nodes(sites.points.row(static_cast<Eigen::Index>(k)), sizes[k]));
  }
  const RbfCorrection evaluator(*rbf_of(task.base));
  const Status filled = fill_grid(
      grid, [&](const Eigen::MatrixXd& points, Eigen::VectorXd& out) { evaluator.evaluate_many(points, out); },
      control);
  if (!filled) return filled.error();
  return FittedCorrection{std::make_shared<const GridCorrection>(std::move(grid)), {}};
}

}  // namespace

const Method kVoxelMethod{
    .name = "voxel",
    .colour = 0x56B4E9,
    .takes = kTakesGrid | kTakesKernel,
    .base = &kDirectMethod,
    .expected_seconds = 0.2,
    .fit = fit_voxel,
};

}  // namespace palpate
