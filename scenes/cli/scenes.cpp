// palpate scenes: lists the scenes.
#include <string>
#include <vector>

#include "scenes/cli/shared.h"
#include "scenes/cli/verbs.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {
namespace {

Status list_scenes() {
  const Result<std::vector<std::string>> names = scene_names();
  if (!names) return names.error();
  std::vector<std::vector<std::string>> rows = {{"SCENE", "TITLE", "MATERIAL", "FEATURES"}};
  for (const std::string& name : *names) {
    const Result<Scene> scene = load_scene(name);
    if (!scene) return scene.error();
    rows.push_back({name, scene->title, scene->material.value_or("-"), describe_features(*scene)});
  }
  print_table(rows, false);
  return {};
}

}  // namespace

void add_scenes(CLI::App& app, Verbs& verbs) {
  verbs.emplace_back(app.add_subcommand("scenes", "List the scenes"), list_scenes);
}

}  // namespace palpate::cli
