#include "scenes/report/plan.h"

#include <utility>

#include "models/correction/methods.h"

namespace palpate {
namespace {

const std::vector<int> kFullCentres{10, 20, 50, 200};
const std::vector<int> kQuickCentres{10, 30};
// Nodes for the depth and for every other feature. Both grids are coarser than the default of a fit.
const std::vector<std::pair<int, int>> kGrids{{7, 4}, {13, 6}};
constexpr std::size_t kMostGridFeatures = 5;  // with more, a fit takes minutes

// A direct fit, and a method that starts from one, takes longer than all else in a quick report.
bool is_slow(const ModelPlan& plan) { return plan.method == &kDirectMethod || plan.method->base != nullptr; }

}  // namespace

bool is_main(const ModelPlan& plan) { return plan.centres == ModelPlan{}.centres && plan.grid.empty(); }

bool is_papers_greedy(const ModelPlan& plan) { return plan.base == Base::force && plan.method == &kGreedyMethod; }

std::vector<ModelPlan> report_plans(bool quick, std::size_t features) {
  std::vector<ModelPlan> plans;
  for (const ModelPlan& plan : all_plans()) {
    if (!quick || !is_slow(plan)) plans.push_back(plan);
  }
  for (const ModelPlan& plan : all_plans()) {
    if (!plan.selects_centres()) continue;
    for (const int centres : quick ? kQuickCentres : kFullCentres) {
      plans.push_back(plan);
      plans.back().centres = centres;
    }
  }
  for (const ModelPlan& plan : all_plans()) {
    if (quick || plan.base == Base::force || !plan.method->can_take(kTakesGrid) || features > kMostGridFeatures)
      continue;
    for (const auto& [depth, other] : kGrids) {
      plans.push_back(plan);
      plans.back().grid.assign(features, other);
      plans.back().grid[0] = depth;
    }
  }
  return plans;
}

}  // namespace palpate
