#include "scenes/worker/slot_plan.h"

#include <algorithm>
#include <filesystem>

#include "engine/tick/haptics_tick.h"
#include "models/model/file/model_io.h"

namespace palpate {
namespace {

Error needs_files(const Scene& scene) {
  return Error{"the scene \"" + scene.name +
               "\" has no virtual material to fit models to; pass model files, made by palpate fit --scene " +
               scene.name};
}

Error unknown_model(const std::string& asked) {
  return Error{"found no model \"" + asked + "\", expected a method (" + method_names() +
               ") or a model file that exists"};
}

Result<SlotPlan> plan_one(const Scene& scene, const std::string& asked) {
  if (const Method* method = find_method(asked)) {
    if (!scene.material) return needs_files(scene);
    return SlotPlan{ModelOrigin::method, method, "", nullptr};
  }
  std::error_code missing;
  if (!std::filesystem::exists(asked, missing)) return unknown_model(asked);
  auto model = load_model(asked);
  if (!model) return model.error();
  return SlotPlan{ModelOrigin::file, &kGreedyMethod, asked, std::move(*model)};
}

}  // namespace

std::string plan_name(const SlotPlan& plan) {
  switch (plan.origin) {
    case ModelOrigin::method: return plan.method->name;
    case ModelOrigin::position: return "position only";
    case ModelOrigin::file: return std::filesystem::path(plan.path).stem().string();
  }
  return {};
}

std::string plan_method(const SlotPlan& plan) {
  switch (plan.origin) {
    case ModelOrigin::method: return plan.method->name;
    case ModelOrigin::position: return "position";
    case ModelOrigin::file: return {};
  }
  return {};
}

Result<std::vector<SlotPlan>> plan_slots(const Scene& scene, const std::vector<std::string>& models,
                                         bool position_only) {
  std::vector<SlotPlan> plans;
  for (const std::string& asked : models.empty() ? scene.default_models : models) {
    Result<SlotPlan> plan = plan_one(scene, asked);
    if (!plan) return plan.error();
    plans.push_back(std::move(*plan));
  }
  if (position_only && scene.material) plans.push_back({ModelOrigin::position, &kGreedyMethod, "", nullptr});
  const bool has_direct = std::any_of(plans.begin(), plans.end(), [](const SlotPlan& plan) {
    return plan.origin == ModelOrigin::method && plan.method == &kDirectMethod;
  });
  if (scene.material && !has_direct) plans.push_back({ModelOrigin::method, &kDirectMethod, "", nullptr});
  if (plans.size() <= kMaxModels) return plans;
  return Error{"found " + std::to_string(plans.size()) + " models, the direct reference included, expected at most " +
               std::to_string(kMaxModels) + "; leave some out"};
}

}  // namespace palpate
