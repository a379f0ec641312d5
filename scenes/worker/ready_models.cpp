#include "scenes/worker/ready_models.h"

#include <filesystem>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"
#include "engine/base/whole_file.h"
#include "models/model/file/model_io.h"
#include "scenes/worker/model_request.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr const char* kInputs = "/inputs.txt";

std::string inputs_of(const Scene& scene, std::uint64_t seed) {
  return "material " + scene.material.value_or("none") + "\nseed " + std::to_string(seed) + "\nfeatures " +
         describe_features(scene) + "\nJND " + general(scene.jnd.offset_N, 17) + " N + " +
         general(scene.jnd.weber_fraction, 17) + " F\n";
}

}  // namespace

ReadyModels::ReadyModels(const std::string& folder, const Scene& scene, std::uint64_t seed) {
  if (folder.empty() || !scene.recordings.empty()) return;
  const std::string of_scene = folder + "/" + scene.name;
  const auto inputs = read_whole_file(of_scene + kInputs);
  if (inputs && *inputs == inputs_of(scene, seed)) folder_ = of_scene;
}

// The name of a plan says nothing of options beside its base, method and size.
bool ReadyModels::has(const ModelPlan& plan) const {
  if (folder_.empty()) return false;
  const auto named = parse_plan(plan_name(plan));
  return named && *named == plan && std::filesystem::exists(file_of(plan));
}

std::shared_ptr<const FittedModel> ReadyModels::read(const ModelPlan& plan) const {
  auto model = load_model(file_of(plan));
  return model ? *model : nullptr;
}

Status make_ready_models(const std::string& folder, const std::string& scene_name) {
  const auto scene = load_scene(scene_name);
  if (!scene) return scene.error();
  const std::string of_scene = folder + "/" + scene_name;
  std::error_code problem;
  std::filesystem::remove_all(of_scene, problem);
  if (!problem) std::filesystem::create_directories(of_scene, problem);
  if (problem) return Error{of_scene + ": " + problem.message()};
  ModelWorker worker(*scene, kSeed);
  for (const std::vector<std::string>& names : {line_ups().front().models, exhibit_models()}) {
    const auto requests = requested_models(*scene, names);
    if (!requests) return requests.error();
    for (const ModelRequest& request : *requests) {
      const auto model = worker.make(request);
      if (!model) return model.error();
      const std::string path = of_scene + "/" + plan_name(request.plan) + ".json";
      if (const Status status = save_model(path, (*model)->data(), true); !status) return status;
    }
  }
  return write_file_atomically(of_scene + kInputs, inputs_of(*scene, kSeed), true);
}

}  // namespace palpate
