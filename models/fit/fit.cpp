#include "models/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <utility>

#include "models/fit/fit_direct.h"
#include "models/fit/fit_greedy.h"
#include "models/fit/fit_kdtree.h"
#include "models/fit/fit_random.h"
#include "models/fit/fill_grid.h"

namespace palpate {
namespace {

// The paper's grid: 25 nodes along the depth, 11 along every other feature; with
// more features fewer each, so that a grid never has more nodes than this.
constexpr int kDepthNodes = 25;
constexpr int kOtherNodes = 11;
constexpr double kMostNodes = 2e5;
constexpr int kPositionOnlyNodes = 200;
// Of a grid that was asked for; a model file holds no more.
constexpr double kMaximumGridNodes = 1e7;

std::vector<int> default_grid(std::size_t features) {
  if (features == 1) return {kPositionOnlyNodes};
  std::vector<int> grid(features, kOtherNodes);
  grid[0] = kDepthNodes;
  const auto nodes = [&] {
    return std::accumulate(grid.begin(), grid.end(), 1.0, [](double product, int n) { return product * n; });
  };
  while (nodes() > kMostNodes && grid.back() > 2) {
    for (std::size_t i = 1; i < features; ++i) --grid[i];
  }
  return grid;
}

// Node coordinates of one axis: half evenly spread, half where the data are.
// A fast poke makes most of an even axis empty and slow motion too coarse.
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
    nodes.push_back(0.5 * (low + share * (high - low)) + 0.5 * quantile);
  }
  return nodes;
}

Result<VoxelGrid> make_grid(const Sites& sites, const RbfFunction& function, std::vector<int> sizes,
                            const FitControl& control) {
  const auto d = static_cast<std::size_t>(sites.dimension());
  if (sizes.empty()) sizes = default_grid(d);
  if (sizes.size() != d) {
    return Error{"the grid has " + std::to_string(sizes.size()) + " sizes, the scene has " + std::to_string(d) +
                 " features; give one size per feature, e.g. --grid 25x11x11x11 for four"};
  }
  VoxelGrid grid;
  const double nodes = std::accumulate(sizes.begin(), sizes.end(), 1.0, [](double product, int n) { return product * n; });
  if (nodes > kMaximumGridNodes) {
    char asked[32];
    std::snprintf(asked, sizeof asked, "%.3g", nodes);
    return Error{"the grid would have " + std::string(asked) + " nodes, at most 1e7 can be saved; give smaller sizes"};
  }
  for (std::size_t k = 0; k < d; ++k) {
    if (sizes[k] < 2) return Error{"a grid needs at least 2 nodes along every feature, found " + std::to_string(sizes[k])};
    grid.nodes.push_back(axis_nodes(sites.points.row(static_cast<Eigen::Index>(k)), sizes[k]));
  }
  const RbfEvaluator evaluator(function);
  const Status filled = fill_grid(
      grid, [&](const Eigen::MatrixXd& points, Eigen::VectorXd& out) { evaluator.evaluate_many(points, out); },
      control);
  if (!filled) return filled.error();
  return grid;
}

Result<FittedRbf> fit_function(const Sites& sites, const Eigen::VectorXd& jnd_N, const MethodRequest& request,
                               const FitControl& control, const MethodFit* direct) {
  if (request.method == Method::voxel && direct != nullptr) return FittedRbf{*direct->data.rbf, direct->report};
  switch (request.method) {
    case Method::random: return fit_random(sites, {request.kernel, request.centres, request.seed}, control);
    case Method::kdtree: return fit_kdtree(sites, jnd_N, {request.kernel, request.centres}, control);
    case Method::greedy:
      return fit_greedy(sites, {request.kernel, request.centres, request.candidates, request.seed}, control);
    case Method::direct:
    case Method::voxel: break;
  }
  DirectOptions options;
  options.kernel = request.kernel;
  options.solver =
      request.solver == DirectSolverChoice::tsvd ? DirectSolver::truncated_svd : DirectSolver::cholesky;
  return fit_direct(sites, options, control);
}

std::string model_name(const MethodRequest& request, const ModelData& data) {
  std::string name(method_name(request.method));
  if (request.method == Method::direct) return name;
  name += '-';
  if (request.method != Method::voxel) return name.append(std::to_string(request.centres));
  for (std::size_t k = 0; k < data.grid->nodes.size(); ++k) {
    if (k > 0) name += 'x';
    name.append(std::to_string(data.grid->nodes[k].size()));
  }
  return name;
}

// Nothing when cancelled.
std::optional<double> share_within_jnd(const PreparedTraining& prepared, const ModelData& data,
                                       const FitControl& control) {
  constexpr std::size_t kBetweenQuestions = 4096;
  const FittedModel model(data);
  std::size_t within = 0;
  for (std::size_t i = 0; i < prepared.judge_force_N.size(); ++i) {
    if (i % kBetweenQuestions == 0 && !control.go_on(0.99)) return std::nullopt;
    const double force_N = model.evaluate(prepared.judge_features[i].data()).force_N;
    if (data.jnd.error_over_jnd(force_N, prepared.judge_force_N[i]) <= 1.0) ++within;
  }
  return static_cast<double>(within) / static_cast<double>(prepared.judge_force_N.size());
}

}  // namespace

std::string_view method_name(Method method) {
  switch (method) {
    case Method::direct: return "direct";
    case Method::voxel: return "voxel";
    case Method::random: return "random";
    case Method::kdtree: return "kdtree";
    case Method::greedy: return "greedy";
  }
  return "greedy";
}

std::optional<Method> method_from_name(std::string_view name) {
  for (const Method method : kMethods) {
    if (method_name(method) == name) return method;
  }
  return std::nullopt;
}

Result<MethodFit> fit_method(const PreparedTraining& prepared, const MethodRequest& request,
                             const FitControl& control, const MethodFit* direct) {
  Eigen::VectorXd jnd_N(prepared.sites.count());
  for (Eigen::Index i = 0; i < jnd_N.size(); ++i) {
    jnd_N(i) = prepared.common.jnd.at(prepared.set.sites[static_cast<std::size_t>(i)].force_N);
  }
  auto fitted = fit_function(prepared.sites, jnd_N, request, control, direct);
  if (!fitted) return fitted.error();
  MethodFit fit{prepared.common, std::move(fitted->report)};
  fit.data.method = method_name(request.method);
  fit.data.provenance.seed = request.seed;
  if (request.method == Method::voxel) {
    auto grid = make_grid(prepared.sites, fitted->function, request.grid, control);
    if (!grid) return grid.error();
    fit.data.grid = std::move(*grid);
  } else {
    fit.data.rbf = std::move(fitted->function);
  }
  fit.data.name = model_name(request, fit.data);
  if (const Status valid = validate_model(fit.data); !valid) {
    return Error{"the " + fit.data.name + " fit did not give a usable model (" + valid.error().message +
                 "); try more smoothing or fewer centres"};
  }
  const std::optional<double> within_jnd = share_within_jnd(prepared, fit.data, control);
  if (!within_jnd || !control.go_on(1.0)) return interrupted();
  fit.data.provenance.training_within_jnd = *within_jnd;
  return fit;
}

}  // namespace palpate
