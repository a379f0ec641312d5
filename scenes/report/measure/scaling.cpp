#include "scenes/report/measure/scaling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "models/model/rbf/rbf_evaluate.h"
#include "models/fit/fit_direct.h"
#include "models/fit/fit_greedy.h"
#include "models/solve/fill_grid.h"
#include "scenes/report/data/plan.h"
#include "scenes/report/measure/stopwatch.h"

namespace palpate {
namespace {

// With fewer a fit takes no time that a clock can tell.
constexpr std::size_t kFewestSites = 100;

// `count` indices below `total`, evenly spread.
std::vector<Eigen::Index> spread(std::size_t total, std::size_t count) {
  std::vector<Eigen::Index> indices;
  for (std::size_t i = 0; i < count; ++i) indices.push_back(static_cast<Eigen::Index>(i * total / count));
  return indices;
}

PreparedTraining with_sites(const PreparedTraining& prepared, std::size_t count) {
  PreparedTraining some = prepared;
  some.set.sites.clear();
  some.sites = Sites{};
  const auto n = static_cast<Eigen::Index>(count);
  some.sites.points.resize(prepared.sites.points.rows(), n);
  some.sites.target_N.resize(n);
  some.sites.row_scale.resize(n);
  Eigen::Index to = 0;
  for (const Eigen::Index from : spread(prepared.set.sites.size(), count)) {
    some.set.sites.push_back(prepared.set.sites[static_cast<std::size_t>(from)]);
    some.sites.points.col(to) = prepared.sites.points.col(from);
    some.sites.target_N(to) = prepared.sites.target_N(from);
    some.sites.row_scale(to) = prepared.sites.row_scale(from);
    if (!prepared.sites.group.empty()) some.sites.group.push_back(prepared.sites.group[static_cast<std::size_t>(from)]);
    ++to;
  }
  // The share within the JND of a fit that is only timed is not wanted.
  some.evaluation_features.resize(1);
  some.evaluation_force_N.resize(1);
  return some;
}

Sites with_dimension(const Sites& sites, int dimension, std::size_t most_sites) {
  const auto total = static_cast<std::size_t>(sites.count());
  const std::vector<Eigen::Index> chosen = spread(total, std::min(total, most_sites));
  Sites some;
  some.points.resize(dimension, static_cast<Eigen::Index>(chosen.size()));
  some.target_N.resize(some.points.cols());
  some.row_scale.resize(some.points.cols());
  for (Eigen::Index i = 0; i < some.points.cols(); ++i) {
    const Eigen::Index from = chosen[static_cast<std::size_t>(i)];
    for (int k = 0; k < dimension; ++k) {
      const int lap = k / sites.dimension();
      const Eigen::Index moved = (from + lap * sites.count() / 3) % sites.count();
      some.points(k, i) = sites.points(k % sites.dimension(), moved);
    }
    some.target_N(i) = sites.target_N(from);
    some.row_scale(i) = sites.row_scale(from);
  }
  return some;
}

Result<double> time_grid(const Sites& sites, const RbfFunction& function, DimensionTime& time,
                         const FitControl& control) {
  VoxelGrid grid;
  for (int k = 0; k < sites.dimension(); ++k) {
    const double low = sites.points.row(k).minCoeff();
    const double high = std::max(sites.points.row(k).maxCoeff(), low + 1e-3);
    std::vector<double> nodes;
    for (int i = 0; i < kNodesPerDimension; ++i) nodes.push_back(low + (high - low) * i / (kNodesPerDimension - 1));
    grid.nodes.push_back(std::move(nodes));
  }
  const Stopwatch start;
  const RbfEvaluator evaluator(function);
  const Status filled = fill_grid(
      grid, [&](const Eigen::MatrixXd& points, Eigen::VectorXd& out) { evaluator.evaluate_many(points, out); },
      control);
  if (!filled) return filled.error();
  time.nodes = grid.node_count();
  return start.seconds();
}

}  // namespace

Result<std::vector<SitesTime>> time_against_sites(const PreparedTraining& prepared, std::size_t most, int halvings,
                                                  const FitControl& control) {
  std::vector<SitesTime> times;
  const std::size_t all = std::min(most, prepared.set.sites.size());
  double done = 0.0;
  for (int halving = halvings; halving >= 0; --halving) {
    const std::size_t asked = all >> halving;
    done += 1.0;
    if (asked < kFewestSites) continue;
    const PreparedTraining some = with_sites(prepared, asked);
    FitControl quiet;
    quiet.progress = [&](double) { return control.may_continue((done - 1.0) / (1.0 + halvings)); };
    std::map<const Method*, std::pair<MethodFit, double>> fitted;
    for (const PlannedModel& model : make_plan(true, prepared.set.features.size()).models) {
      if (!model.main || model.rung != Rung::palpate) continue;
      const auto base = fitted.find(model.request.method->base);
      const bool has_base = base != fitted.end();
      const Stopwatch start;
      auto fit = fit_method(some, model.request, quiet, has_base ? &base->second.first : nullptr);
      if (!fit) return fit.error();
      const double seconds = start.seconds();
      times.push_back({model.name, asked, seconds + (has_base ? base->second.second : 0.0)});
      fitted.try_emplace(model.request.method, std::move(*fit), seconds);
    }
  }
  return times;
}

Result<std::vector<DimensionTime>> time_against_dimension(const Sites& sites, int most_dimensions,
                                                          std::size_t most_sites, const FitControl& control) {
  std::vector<DimensionTime> times;
  for (int dimension = 1; dimension <= most_dimensions; ++dimension) {
    FitControl quiet;
    quiet.progress = [&](double) { return control.may_continue((dimension - 1.0) / most_dimensions); };
    const Sites some = with_dimension(sites, dimension, most_sites);
    DimensionTime time;
    time.dimension = dimension;
    Stopwatch start;
    const auto direct = fit_direct(some, {}, quiet);
    if (!direct) return direct.error();
    time.direct_seconds = start.seconds();
    const auto grid = time_grid(some, direct->function, time, quiet);
    if (!grid) return grid.error();
    time.grid_seconds = *grid;
    start = Stopwatch();
    const auto greedy = fit_greedy(some, {}, quiet);
    if (!greedy) return greedy.error();
    time.greedy_seconds = start.seconds();
    times.push_back(time);
  }
  return times;
}

}  // namespace palpate
