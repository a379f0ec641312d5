#include "scenes/worker/model_worker.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "engine/tick/haptics_tick.h"
#include "models/correction/methods.h"
#include "models/model/file/model_io.h"

namespace palpate {
namespace {

Result<ModelRequest> request_of(const Scene& scene, const std::string& asked) {
  const auto plan = parse_plan(asked);
  std::error_code missing;
  if (plan && scene.has_material()) return ModelRequest{*plan};
  if (plan) {
    return Error{"the scene \"" + scene.name +
                 "\" has no virtual material to fit models to; pass model files, made by palpate fit --scene " +
                 scene.name};
  }
  if (!std::filesystem::exists(asked, missing)) {
    return Error{"found no model \"" + asked + "\", expected the name of a model (" + family_names() +
                 ") or a model file that exists"};
  }
  auto model = load_model(asked);
  if (!model) return model.error();
  return ModelRequest{.plan = {}, .path = asked, .loaded = std::move(*model)};
}

// The names of all plans on this base but that of the interpolation of every sample; on the force also the default.
std::vector<std::string> plans_on(Base base) {
  std::vector<std::string> names;
  for (const ModelPlan& plan : all_plans())
    if (plan.base == base && plan.method != &kDirectMethod) names.push_back(plan_name(plan));
  if (base == Base::force) names.push_back(plan_name(ModelPlan{}));
  return names;
}

}  // namespace

std::string request_name(const ModelRequest& request) {
  return request.is_file() ? std::filesystem::path(request.path).stem().string() : plan_name(request.plan);
}

const std::vector<LineUp>& line_ups() {
  static const std::vector<LineUp> all = {
      {"Comparison", "the methods of Hoever & Harders (2009) with 100 centres, and this program's best",
       plans_on(Base::force)},
      {"Sizes",
       "the greedy method with 10 to 200 centres",
       {"greedy-10", "greedy-20", "greedy-50", "greedy-100", "greedy-200"}},
      {"Corrections", "the trend alone, and with the correction of each method", plans_on(Base::trend)},
      {"Direct",
       "the interpolation of every sample",
       {kDirectMethod.name, kVoxelMethod.name, "trend+direct", "trend+greedy-100"}}};
  return all;
}

const std::vector<MethodChoice>& method_choices() {
  static const std::vector<MethodChoice> all = [] {
    std::vector<MethodChoice> choices;
    for (const ModelPlan& plan : all_plans()) choices.push_back({family_name(plan), plan.selects_centres()});
    return choices;
  }();
  return all;
}

const LineUp* find_line_up(const std::string& name) {
  const auto found = std::ranges::find(line_ups(), name, &LineUp::name);
  return found == line_ups().end() ? nullptr : &*found;
}

const std::vector<std::string>& exhibit_models() {
  static const std::vector<std::string> all{"kdtree-2", "random-20", "trend+greedy-100"};
  return all;
}

Result<std::vector<ModelRequest>> requested_models(const Scene& scene, const std::vector<std::string>& models) {
  std::vector<ModelRequest> requests;
  // Without a material and without named models, the session waits for a file.
  if (models.empty() && !scene.has_material()) return requests;
  for (const std::string& asked : models.empty() ? line_ups().front().models : models) {
    auto request = request_of(scene, asked);
    if (!request) return request.error();
    requests.push_back(std::move(*request));
  }
  if (requests.size() <= kMaxModels) return requests;
  return Error{"found " + std::to_string(requests.size()) + " models, expected at most " + std::to_string(kMaxModels) +
               "; leave some out"};
}

}  // namespace palpate
