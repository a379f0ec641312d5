#include "scenes/worker/slot_plan.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/tick/haptics_tick.h"
#include "models/model/file/model_io.h"

namespace palpate {
namespace {

const std::vector<std::string> kDefaultModels{"greedy", "kdtree", "random", "voxel", "direct"};

// Parses "greedy", "greedy-10" or "2009-greedy-10"; empty if it names no method.
std::optional<SlotPlan> plan_method_of(std::string asked) {
  SlotPlan plan;
  if (asked.rfind(kPaperPrefix, 0) == 0) {
    plan.recipe = Recipe::paper;
    asked.erase(0, std::string_view(kPaperPrefix).size());
  }
  plan.method = find_method(asked);
  if (plan.method != nullptr) return plan;
  const std::size_t dash = asked.rfind('-');
  if (dash == std::string::npos) return std::nullopt;
  const std::string count = asked.substr(dash + 1);
  plan.method = find_method(asked.substr(0, dash));
  const bool number = !count.empty() && count.size() <= 4 && count.find_first_not_of("0123456789") == std::string::npos;
  if (plan.method == nullptr || !number || !plan.method->can_take(kTakesCentres)) return std::nullopt;
  plan.centres = std::max(1, std::stoi(count));
  return plan;
}

Result<SlotPlan> plan_one(const Scene& scene, const std::string& asked) {
  if (auto plan = plan_method_of(asked)) {
    if (scene.has_material()) return std::move(*plan);
    return Error{"the scene \"" + scene.name +
                 "\" has no virtual material to fit models to; pass model files, made by palpate fit --scene " +
                 scene.name};
  }
  std::error_code missing;
  if (!std::filesystem::exists(asked, missing)) {
    return Error{"found no model \"" + asked + "\", expected a method (" + method_names() +
                 ") or a model file that exists"};
  }
  auto model = load_model(asked);
  if (!model) return model.error();
  return SlotPlan{.path = asked, .loaded = std::move(*model)};
}

}  // namespace

std::string plan_name(const SlotPlan& plan) {
  if (plan.is_file()) return std::filesystem::path(plan.path).stem().string();
  return model_name(plan.recipe, *plan.method, plan.centres);
}

const std::vector<LineUp>& line_ups() {
  static const std::vector<LineUp> all = {
      {"Ladder",
       "the paper's recipe with 10 centres beside this program's fits",
       {"greedy", "2009-random-10", "2009-greedy-10", "2009-kdtree-10", "voxel", "direct", "trend"}},
      {"2009",
       "the paper's recipe with few centres, the grid and all sites",
       {"2009-random-10", "2009-kdtree-10", "2009-greedy-10", "2009-voxel", "2009-direct"}},
      {"Palpate", "this program's fit of every method", {"greedy", "kdtree", "random", "voxel", "direct", "trend"}}};
  return all;
}

const LineUp* find_line_up(const std::string& name) {
  const auto found = std::ranges::find(line_ups(), name, &LineUp::name);
  return found == line_ups().end() ? nullptr : &*found;
}

std::string plan_method(const SlotPlan& plan) {
  if (plan.is_file()) return {};
  return plan.recipe == Recipe::position ? "position" : plan.method->name;
}

Result<std::vector<SlotPlan>> plan_slots(const Scene& scene, const std::vector<std::string>& models,
                                         bool position_only) {
  std::vector<SlotPlan> plans;
  // Without a material and without named models, the session waits for a file.
  if (models.empty() && !scene.has_material()) return plans;
  for (const std::string& asked : models.empty() ? kDefaultModels : models) {
    Result<SlotPlan> plan = plan_one(scene, asked);
    if (!plan) return plan.error();
    plans.push_back(std::move(*plan));
  }
  if (position_only && scene.has_material()) plans.push_back({.recipe = Recipe::position});
  const bool has_direct = std::ranges::any_of(plans, [](const SlotPlan& plan) {
    return !plan.is_file() && plan.method == &kDirectMethod && plan.recipe == Recipe::palpate;
  });
  const bool fits = !std::ranges::all_of(plans, &SlotPlan::is_file);
  if ((scene.material || fits) && !has_direct) plans.push_back({.method = &kDirectMethod});
  if (plans.size() <= kMaxModels) return plans;
  return Error{"found " + std::to_string(plans.size()) + " models, the direct reference included, expected at most " +
               std::to_string(kMaxModels) + "; leave some out"};
}

}  // namespace palpate
