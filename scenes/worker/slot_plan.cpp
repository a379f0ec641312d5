#include "scenes/worker/slot_plan.h"

#include <algorithm>
#include <filesystem>
#include <optional>

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
  std::string methods;
  for (const Method method : kMethods) methods += (methods.empty() ? "" : ", ") + std::string(method_name(method));
  return Error{"found no model \"" + asked + "\", expected a method (" + methods + ") or a model file that exists"};
}

Result<SlotPlan> plan_one(const Scene& scene, const std::string& asked) {
  if (const std::optional<Method> method = method_from_name(asked)) {
    if (!scene.material) return needs_files(scene);
    return SlotPlan{ModelOrigin::method, *method, "", nullptr};
  }
  std::error_code missing;
  if (!std::filesystem::exists(asked, missing)) return unknown_model(asked);
  auto model = load_model(asked);
  if (!model) return model.error();
  return SlotPlan{ModelOrigin::file, Method::greedy, asked, std::move(*model)};
}

}  // namespace

std::string plan_name(const SlotPlan& plan) {
  switch (plan.origin) {
    case ModelOrigin::method: return std::string(method_name(plan.method));
    case ModelOrigin::position: return "position only";
    case ModelOrigin::file: return std::filesystem::path(plan.path).stem().string();
  }
  return {};
}

std::string plan_method(const SlotPlan& plan) {
  switch (plan.origin) {
    case ModelOrigin::method: return std::string(method_name(plan.method));
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
  if (position_only && scene.material) plans.push_back({ModelOrigin::position, Method::greedy, "", nullptr});
  const bool has_direct = std::any_of(plans.begin(), plans.end(), [](const SlotPlan& plan) {
    return plan.origin == ModelOrigin::method && plan.method == Method::direct;
  });
  if (scene.material && !has_direct) plans.push_back({ModelOrigin::method, Method::direct, "", nullptr});
  if (plans.size() <= kMaxModels) return plans;
  return Error{"found " + std::to_string(plans.size()) + " models, the direct reference included, expected at most " +
               std::to_string(kMaxModels) + "; leave some out"};
}

}  // namespace palpate
