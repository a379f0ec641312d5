#include "scenes/cli/replay_files.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/csv_scanner.h"
#include "engine/recording/recording_reader.h"
#include "engine/tick/haptics_tick.h"
#include "models/model/file/model_io.h"

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

std::vector<std::string> distinct_names(const std::vector<std::string>& names) {
  std::vector<std::string> distinct;
  const auto taken = [&](const std::string& name) {
    return std::find(distinct.begin(), distinct.end(), name) != distinct.end();
  };
  for (const std::string& name : names) {
    std::string candidate = name;
    for (int i = 2; taken(candidate); ++i) candidate = name + "-" + std::to_string(i);
    distinct.push_back(candidate);
  }
  return distinct;
}

Result<ForcesFile> ForcesFile::create(const std::string& path, bool overwrite, const ForceModels& models,
                                      const std::vector<std::string>& names) {
  Result<AtomicFile> file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  ForcesFile forces(std::move(*file));
  std::vector<FeatureSpec> specs;
  std::vector<std::string> feature_names;
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::size_t i = 0; i < models[m]->features().size(); ++i) {
      const FeatureSpec& spec = models[m]->features()[i];
      if (std::find(specs.begin(), specs.end(), spec) != specs.end()) continue;
      specs.push_back(spec);
      feature_names.push_back(feature_name(spec));
      forces.columns_.push_back({m, i});
    }
  }
  std::string header = "time_s,position_m,force_N,depth_m";
  for (const std::string& name : distinct_names(feature_names)) header += "," + name;
  for (const std::string& name : names) header += "," + name + "_N";
  forces.file_.write(header + "\n");
  return forces;
}

void ForcesFile::add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
  std::string line;
  const auto append = [&](double value) { (line += line.empty() ? "" : ",") += shortest(value); };
  for (const double value : {row.time_s, row.position_m, row.force_N, snapshot.depth_m}) append(value);
  for (const FeatureColumn& column : columns_) {
    append(tick.features_of(column.model).values[column.index]);
  }
  for (std::size_t m = 0; m < tick.model_count(); ++m) append(snapshot.force_N[m]);

  file_.write(line + "\n");
}

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
