// palpate scenes: what there is to touch.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "scenes/cli/verbs.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {
namespace {

using Row = std::vector<std::string>;

void print_table(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line.append(widths[i] - row[i].size() + 2, ' ');
    }
    std::printf("%s\n", line.c_str());
  }
}

Status list_scenes() {
  const Result<std::vector<std::string>> names = scene_names();
  if (!names) return names.error();
  std::vector<Row> rows = {{"SCENE", "TITLE", "MATERIAL", "FEATURES"}};
  for (const std::string& name : *names) {
    const Result<Scene> scene = load_scene(name);
    if (!scene) return scene.error();
    rows.push_back({name, scene->title, scene->material.value_or("-"), describe_features(*scene)});
  }
  print_table(rows);
  return {};
}

}  // namespace

void add_scenes(CLI::App& app, Verbs& verbs) {
  verbs.emplace_back(app.add_subcommand("scenes", "List the scenes"), list_scenes);
}

}  // namespace palpate::cli
