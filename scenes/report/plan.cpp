#include "scenes/report/plan.h"

#include <utility>

namespace palpate {
namespace {

constexpr int kMainCentres = 100;  // the paper's
const std::vector<int> kFullCentres{10, 20, 50, 200, 500};
const std::vector<int> kPaperCentres{10, 20, 50, 200};
const std::vector<int> kQuickCentres{10, 30};
// Nodes for the depth and for every other feature. Both grids are coarser than the default of a fit.
const std::vector<std::pair<int, int>> kGrids{{7, 4}, {13, 6}};
constexpr std::size_t kMostGridFeatures = 5;  // with more, a fit takes minutes

PlannedModel planned(Recipe of, const Method& method, int centres) {
  return {model_name(of, method, centres), of, {.method = &method, .centres = centres}, centres == kMainCentres};
}

// A direct fit, and a method that starts from one, takes longer than all else in a quick report.
bool is_slow(const Method& method) { return &method == &kDirectMethod || method.base != nullptr; }

}  // namespace

std::vector<PlannedModel> make_plan(bool quick, std::size_t features) {
  std::vector<PlannedModel> plan{planned(Recipe::no_force, kTrendMethod, kMainCentres),
                                 planned(Recipe::palpate, kTrendMethod, kMainCentres)};
  for (const Recipe of : {Recipe::paper, Recipe::palpate}) {
    for (const Method* method : methods()) {
      const bool grid_of_2009 = of == Recipe::paper && method->can_take(kTakesGrid);
      if (method == &kTrendMethod || (quick && is_slow(*method)) || grid_of_2009) continue;
      plan.push_back(planned(of, *method, kMainCentres));
    }
  }
  for (const Recipe of : {Recipe::paper, Recipe::palpate}) {
    for (const Method* method : methods()) {
      if (!method->can_take(kTakesCentres)) continue;
      for (const int centres : quick ? kQuickCentres : of == Recipe::paper ? kPaperCentres : kFullCentres) {
        plan.push_back(planned(of, *method, centres));
      }
    }
  }
  for (const Method* method : methods()) {
    if (quick || !method->can_take(kTakesGrid) || features > kMostGridFeatures) continue;
    for (const auto& [depth, other] : kGrids) {
      PlannedModel grid = planned(Recipe::palpate, *method, 0);
      grid.request.grid.assign(features, other);
      grid.request.grid[0] = depth;
      grid.name.append("-").append(std::to_string(depth)).append("x").append(std::to_string(other));
      plan.push_back(std::move(grid));
    }
  }
  return plan;
}

}  // namespace palpate
