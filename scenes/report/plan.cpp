#include "scenes/report/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

constexpr std::array<int, 8> kFullCentres{10, 20, 50, 100, 200, 500, 1000, 2000};
constexpr std::array<int, 3> kQuickCentres{10, 30, 100};
constexpr int kMainCentres = 100;
// 6,800 sites: 10 s; 2,000 centres would take most of a minute more than everything else.
constexpr int kMostGreedyCentres = 1000;
constexpr int kFewCandidates = 20;  // the paper's other choice beside 100
constexpr std::uint64_t kSeeds = 10;
// A grid finer than this is not worth its minutes in a comparison.
constexpr double kMostGridNodes = 3e5;

PlannedModel planned(Method method, int centres, bool main) {
  PlannedModel model;
  model.request.method = method;
  model.request.centres = centres;
  model.main = main;
  model.name = std::string(method_name(method));
  if (method != Method::direct) model.name.append("-").append(std::to_string(centres));
  return model;
}

PlannedModel few_candidates() {
  PlannedModel model = planned(Method::greedy, kMainCentres, true);
  model.request.candidates = kFewCandidates;
  model.name.append("-of-").append(std::to_string(kFewCandidates));
  return model;
}

PlannedModel grid(std::vector<int> sizes) {
  PlannedModel model = planned(Method::voxel, 0, false);
  model.name = "voxel-";
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (k > 0) model.name += 'x';
    model.name.append(std::to_string(sizes[k]));
  }
  model.request.grid = std::move(sizes);
  return model;
}

// Coarser and finer than the grid that `palpate fit` takes by itself.
void add_grids(ReportPlan& plan, bool quick, std::size_t features) {
  if (features == 1) {
    for (const int nodes : {10, 30, 1000}) plan.models.push_back(grid({nodes}));
    return;
  }
  for (const auto& [depth, other] : {std::pair{7, 4}, std::pair{13, 6}, std::pair{19, 8}, std::pair{37, 15}}) {
    if (quick && depth != 13) continue;
    std::vector<int> sizes(features, other);
    sizes[0] = depth;
    if (depth * std::pow(other, static_cast<double>(features - 1)) <= kMostGridNodes) {
      plan.models.push_back(grid(std::move(sizes)));
    }
  }
}

}  // namespace

ReportPlan make_plan(bool quick, std::size_t features) {
  ReportPlan plan;
  plan.models = {planned(Method::direct, 0, true),
                 planned(Method::voxel, 0, true),
                 planned(Method::random, kMainCentres, true),
                 planned(Method::kdtree, kMainCentres, true),
                 few_candidates(),
                 planned(Method::greedy, kMainCentres, true)};
  plan.models[1].name = "voxel";
  const std::vector<int> sizes = quick ? std::vector<int>(kQuickCentres.begin(), kQuickCentres.end())
                                       : std::vector<int>(kFullCentres.begin(), kFullCentres.end());
  for (const Method method : {Method::random, Method::kdtree, Method::greedy}) {
    for (const int centres : sizes) {
      if (method == Method::greedy && centres > kMostGreedyCentres) continue;
      if (centres != kMainCentres) plan.models.push_back(planned(method, centres, false));
    }
  }
  add_grids(plan, quick, features);
  plan.repeated = {planned(Method::random, kMainCentres, false)};
  plan.repeated.push_back(quick ? few_candidates() : planned(Method::greedy, kMainCentres, false));
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) plan.seeds.push_back(seed);
  plan.site_counts = quick ? std::vector<std::size_t>{500, 1000, 2000}
                           : std::vector<std::size_t>{500, 1000, 2000, 4000, 6850};
  plan.most_dimensions = quick ? 4 : 6;
  plan.dimension_sites = quick ? 1000 : 6850;  // the paper had 6,850
  return plan;
}

double expected_seconds(const MethodRequest& request) {
  const double hundreds = 0.01 * request.centres;
  switch (request.method) {
    case Method::direct: return 3.0;
    case Method::voxel: return 0.2;
    case Method::random: return 0.1 + 0.02 * hundreds * hundreds;
    case Method::kdtree: return 0.1 + 0.01 * hundreds * hundreds * hundreds;
    case Method::greedy: return 0.1 + (0.05 + 0.001 * request.candidates) * hundreds * hundreds;
  }
  return 1.0;
}

}  // namespace palpate
