#include "scenes/scene/scene.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/base/text.h"
#include "engine/base/whole_file.h"
#include "models/fit/fit.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

// `folder`, or if it is empty that of the assets.
Result<std::string> scenes_folder(const std::string& folder) {
  if (!folder.empty()) return folder;
  const Result<std::string> assets = find_assets();
  return assets ? *assets + "/scenes" : assets;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

// Scenes have no other kinds of features; fits identify the others.
std::string describe_features(const Scene& scene) {
  std::vector<std::string> words;
  for (const FeatureSpec& feature : scene.features) {
    words.push_back(feature.kind == FeatureKind::depth ? "depth"
                    : feature.kind == FeatureKind::velocity
                        ? "velocity"
                        : "relaxation " + general(feature.relaxation_time_s, 6) + " s");
  }
  return joined(words);
}

Result<std::vector<std::string>> scene_names(const std::string& in_folder) {
  const Result<std::string> folder = scenes_folder(in_folder);
  if (!folder) return folder.error();
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(*folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".json") names.push_back(entry->path().stem().string());
  }
  if (error) return Error{"cannot list the scenes in " + *folder + ": " + error.message()};
  std::sort(names.begin(), names.end());
  return names;
}

Result<Scene> load_scene(const std::string& name, const std::string& in_folder) {
  const Result<std::string> folder = scenes_folder(in_folder);
  if (!folder) return folder.error();
  const Result<std::vector<std::string>> names = scene_names(*folder);
  if (!names) return names.error();
  if (std::find(names->begin(), names->end(), name) == names->end()) {
    return Error{"unknown scene \"" + name + "\"; known scenes: " + joined(*names)};
  }
  const std::string path = *folder + "/" + name + ".json";
  const Result<std::string> text = read_plain_file(path, "a scene");
  if (!text) return text.error();
  return parse_scene(*text, path);
}

TrainingRequest training_request(const Scene& scene) {
  TrainingRequest request;
  request.scene = scene.name;
  request.features = scene.features;
  request.jnd = scene.jnd;
  request.choice = FeatureChoice::automatic;
  return request;
}

std::uint32_t method_rgb(std::string_view method) {
  constexpr std::uint32_t kPositionColour = 0xF0E442;  // from the palette of Okabe & Ito; grey is the JND band
  if (method == "position") return kPositionColour;
  const Method* row = find_method(method);
  return row == nullptr ? kNeutralColour : row->colour;
}

}  // namespace palpate
