#include "scenes/cli/loaded_models.h"

#include <algorithm>
#include <filesystem>

#include "engine/recording/recording.h"
#include "engine/tick/haptics_tick.h"
#include "models/model/file/model_io.h"
#include "scenes/cli/forces_file.h"

namespace palpate::cli {
namespace {

bool is_recording(const std::string& path) { return RecordingReader::open(path).ok(); }

Error recording_as_model(const std::string& path) {
  return Error{path + " is a recording, expected a model file (JSON, made by palpate fit); give it with --recording"};
}

// Models of one name by their files.
std::vector<std::string> told_apart(const std::vector<std::string>& names, const std::vector<std::string>& paths) {
  std::vector<std::string> result = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::count(names.begin(), names.end(), names[i]) > 1)
      result[i] = std::filesystem::path(paths[i]).stem().string();
  }
  return result;
}

}  // namespace

Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& given) {
  if (paths.size() > kMaxModels) {
    return Error{"found " + std::to_string(paths.size()) + " models, expected at most " + std::to_string(kMaxModels) +
                 "; replay them in several runs"};
  }
  if (!given.empty() && given.size() != paths.size()) {
    return Error{"found " + std::to_string(given.size()) + " names for " + std::to_string(paths.size()) +
                 " models, expected one each; give --name once for every --model"};
  }
  std::vector<LoadedModel> models;
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    auto model = load_model(path);
    if (!model) return is_recording(path) ? recording_as_model(path) : model.error();
    names.push_back((*model)->name());
    models.push_back({"", *model});
  }
  names = distinct_names(given.empty() ? told_apart(names, paths) : given);
  for (std::size_t i = 0; i < names.size(); ++i) models[i].name = names[i];
  return models;
}

}  // namespace palpate::cli
