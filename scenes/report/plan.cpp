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

PlannedModel planned(const Method& method, int centres, bool main) {
  PlannedModel model;
  model.request.method = &method;
  model.request.centres = centres;
  model.main = main;
  model.name = method.name;
  if (method.can_take(kTakesCentres)) model.name.append("-").append(std::to_string(centres));
  return model;
}

PlannedModel few_candidates(const Method& method, bool main) {
  PlannedModel model = planned(method, kMainCentres, main);
  model.request.candidates = kFewCandidates;
  model.name.append("-of-").append(std::to_string(kFewCandidates));
  return model;
}

PlannedModel grid(const Method& method, std::vector<int> sizes) {
  PlannedModel model = planned(method, 0, false);
  for (std::size_t k = 0; k < sizes.size(); ++k) model.name.append(k == 0 ? "-" : "x").append(std::to_string(sizes[k]));
  model.request.grid = std::move(sizes);
  return model;
}

// Coarser and finer than the grid that `palpate fit` takes by itself.
void add_grids(ReportPlan& plan, const Method& method, bool quick, std::size_t features) {
  if (features == 1) {
    for (const int nodes : {10, 30, 1000}) plan.models.push_back(grid(method, {nodes}));
    return;
  }
  for (const auto& [depth, other] : {std::pair{7, 4}, std::pair{13, 6}, std::pair{19, 8}, std::pair{37, 15}}) {
    if (quick && depth != 13) continue;
    std::vector<int> sizes(features, other);
    sizes[0] = depth;
    if (depth * std::pow(other, static_cast<double>(features - 1)) <= kMostGridNodes) {
      plan.models.push_back(grid(method, std::move(sizes)));
    }
  }
}

}  // namespace

ReportPlan make_plan(bool quick, std::size_t features) {
  ReportPlan plan;
  for (const Method* method : methods()) {
    if (method->can_take(kTakesCandidates)) plan.models.push_back(few_candidates(*method, true));
    plan.models.push_back(planned(*method, kMainCentres, true));
  }
  const std::vector<int> sizes = quick ? std::vector<int>(kQuickCentres.begin(), kQuickCentres.end())
                                       : std::vector<int>(kFullCentres.begin(), kFullCentres.end());
  for (const Method* method : methods()) {
    if (!method->can_take(kTakesCentres)) continue;
    for (const int centres : sizes) {
      if (method->can_take(kTakesCandidates) && centres > kMostGreedyCentres) continue;
      if (centres != kMainCentres) plan.models.push_back(planned(*method, centres, false));
    }
  }
  for (const Method* method : methods()) {
    if (method->can_take(kTakesGrid)) add_grids(plan, *method, quick, features);
    if (!method->can_take(kTakesSeed)) continue;
    const bool few = quick && method->can_take(kTakesCandidates);
    plan.repeated.push_back(few ? few_candidates(*method, true) : planned(*method, kMainCentres, false));
  }
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) plan.seeds.push_back(seed);
  plan.site_counts = quick ? std::vector<std::size_t>{500, 1000, 2000}
                           : std::vector<std::size_t>{500, 1000, 2000, 4000, 6850};
  plan.most_dimensions = quick ? 4 : 6;
  plan.dimension_sites = quick ? 1000 : 6850;  // the paper had 6,850
  return plan;
}

}  // namespace palpate
