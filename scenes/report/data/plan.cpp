#include "scenes/report/data/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

constexpr std::array<int, 7> kFullCentres{10, 20, 50, 100, 200, 500, 1000};
// The paper's recipe keeps fewer sites, and its curve is there for comparison.
constexpr std::array<int, 5> kPaperCentres{10, 20, 50, 100, 200};
constexpr std::array<int, 3> kQuickCentres{10, 30, 100};
constexpr int kMainCentres = 100;
// With 6,600 sites 10 processor-seconds; 1,000 would take as long as everything else.
constexpr int kMostGreedyCentres = 500;
constexpr int kFewCandidates = 20;  // the paper's other choice beside 100
constexpr std::uint64_t kSeeds = 10;
// A grid finer than this is not worth its minutes in a comparison.
constexpr double kMostGridNodes = 3e5;

constexpr int kMostCandidateCentres = 200;

PlannedModel planned(const ReportRecipe& recipe, Rung rung, const Method& method, int centres, bool main) {
  PlannedModel model;
  model.rung = rung;
  model.request.method = &method;
  model.request.centres = centres;
  model.request.kernel = recipe.kernel;
  model.main = main;
  if (rung == Rung::paper) model.name = "paper-";
  model.name.append(method.name);
  if (method.can_take(kTakesCentres)) model.name.append("-").append(std::to_string(centres));
  return model;
}

PlannedModel few_candidates(const ReportRecipe& recipe, Rung rung, const Method& method) {
  PlannedModel model = planned(recipe, rung, method, kMainCentres, false);
  model.request.candidates = kFewCandidates;
  model.name.append("-of-").append(std::to_string(kFewCandidates));
  return model;
}

PlannedModel grid(const ReportRecipe& recipe, const Method& method, std::vector<int> sizes) {
  PlannedModel model = planned(recipe, Rung::palpate, method, 0, false);
  for (std::size_t k = 0; k < sizes.size(); ++k) model.name.append(k == 0 ? "-" : "x").append(std::to_string(sizes[k]));
  model.request.grid = std::move(sizes);
  return model;
}

// Coarser and finer than the grid that `palpate fit` takes by itself.
void add_grids(ReportPlan& plan, const Method& method, bool quick, std::size_t features) {
  if (features == 1) {
    for (const int nodes : {10, 30, 1000}) plan.models.push_back(grid(plan.recipe, method, {nodes}));
    return;
  }
  for (const auto& [depth, other] : {std::pair{7, 4}, std::pair{13, 6}, std::pair{19, 8}, std::pair{37, 15}}) {
    if (quick && depth != 13) continue;
    std::vector<int> sizes(features, other);
    sizes[0] = depth;
    if (depth * std::pow(other, static_cast<double>(features - 1)) <= kMostGridNodes) {
      plan.models.push_back(grid(plan.recipe, method, std::move(sizes)));
    }
  }
}

std::vector<Rung> rungs_of(const ReportRecipe& recipe) {
  std::vector<Rung> rungs;
  if (recipe.paper) rungs.push_back(Rung::paper);
  if (recipe.palpate) rungs.push_back(Rung::palpate);
  return rungs;
}

void add_main(ReportPlan& plan) {
  plan.models.push_back(planned(plan.recipe, Rung::no_force, kTrendMethod, 0, true));
  plan.models.back().name = "no-force";
  plan.models.push_back(planned(plan.recipe, Rung::trend, kTrendMethod, 0, true));
  for (const Rung rung : rungs_of(plan.recipe)) {
    for (const Method* method : methods()) {
      if (method != &kTrendMethod) plan.models.push_back(planned(plan.recipe, rung, *method, kMainCentres, true));
    }
  }
}

std::vector<int> sizes_of(Rung rung, bool quick) {
  if (quick) return {kQuickCentres.begin(), kQuickCentres.end()};
  if (rung == Rung::paper) return {kPaperCentres.begin(), kPaperCentres.end()};
  return {kFullCentres.begin(), kFullCentres.end()};
}

void add_sizes(ReportPlan& plan, bool quick) {
  for (const Rung rung : rungs_of(plan.recipe)) {
    for (const Method* method : methods()) {
      if (!method->can_take(kTakesCentres)) continue;
      for (const int centres : sizes_of(rung, quick)) {
        if (method->can_take(kTakesCandidates) && centres > kMostGreedyCentres) continue;
        if (centres != kMainCentres) plan.models.push_back(planned(plan.recipe, rung, *method, centres, false));
      }
      if (method->can_take(kTakesCandidates)) plan.models.push_back(few_candidates(plan.recipe, rung, *method));
    }
  }
}

}  // namespace

ReportPlan make_plan(bool quick, std::size_t features, const ReportRecipe& recipe) {
  ReportPlan plan;
  plan.quick = quick;
  plan.recipe = recipe;
  add_main(plan);
  add_sizes(plan, quick);
  const Rung rung = recipe.palpate ? Rung::palpate : Rung::paper;
  for (const Method* method : methods()) {
    if (method->can_take(kTakesGrid) && recipe.palpate) add_grids(plan, *method, quick, features);
    if (!method->can_take(kTakesSeed)) continue;
    const bool few = quick && method->can_take(kTakesCandidates);
    plan.repeated.push_back(few ? few_candidates(recipe, rung, *method)
                                : planned(recipe, rung, *method, kMainCentres, false));
  }
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) plan.seeds.push_back(seed);
  plan.most_sites = quick ? 1000 : 6850;  // the paper had 6,850
  plan.site_halvings = quick ? 3 : 4;
  plan.left_out_folds = quick ? 1 : 2;
  plan.most_dimensions = quick ? 4 : 6;
  plan.dimension_sites = quick ? 500 : 2500;
  return plan;
}

const PlannedModel* representative(const ReportPlan& plan, Rung rung) {
  const PlannedModel* last = nullptr;
  for (const PlannedModel& model : plan.models) {
    if (model.main && model.rung == rung) last = &model;
  }
  return last;
}

bool is_candidate(const PlannedModel& model, bool quick) {
  const Method& method = *model.request.method;
  // A direct fit takes longer than everything else of a quick report.
  if (quick && (method.can_take(kTakesSolver) || method.base != nullptr)) return false;
  if (model.rung == Rung::no_force || model.few_candidates()) return false;
  if (method.can_take(kTakesGrid) && !model.main) return false;
  return !method.can_take(kTakesCentres) || model.request.centres <= kMostCandidateCentres;
}

}  // namespace palpate
