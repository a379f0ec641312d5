#include "scenes/cli/replay_files.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/tick/haptics_tick.h"
#include "scenes/cli/shared.h"
#include "scenes/plot/draw.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {
std::vector<std::string> distinct_names(const std::vector<std::string>& names) {
  std::vector<std::string> distinct;
  for (const std::string& name : names) {
    std::string candidate = name;
    for (int i = 2; std::ranges::count(distinct, candidate) > 0; ++i) candidate = name + "-" + std::to_string(i);
    distinct.push_back(candidate);
  }
  return distinct;
}

Result<ForcesFile> ForcesFile::create(const std::string& path, bool overwrite, const std::vector<LoadedModel>& models) {
  Result<AtomicFile> file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  ForcesFile forces(std::move(*file));
  std::vector<FeatureSpec> specs;
  std::vector<std::string> feature_names;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::vector<FeatureSpec>& features = models[m].model->features();
    for (std::size_t i = 0; i < features.size(); ++i) {
      const FeatureSpec& spec = features[i];
      if (std::ranges::count(specs, spec) > 0) continue;
      specs.push_back(spec);
      feature_names.push_back(feature_name(spec));
      forces.columns_.emplace_back(m, i);
    }
  }
  std::string header = "time_s,position_m,force_N,depth_m";
  for (const std::string& name : distinct_names(feature_names)) header += "," + name;
  for (const LoadedModel& one : models) header += "," + one.name + "_N";
  forces.file_.write(header + "\n");
  return forces;
}

void ForcesFile::add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
  std::string line;
  const auto append = [&](double value) { (line += line.empty() ? "" : ",") += shortest(value); };
  for (const double value : {row.time_s, row.position_m, row.force_N, snapshot.depth_m}) append(value);
  for (const auto& [model, index] : columns_) append(tick.features_of(model).values[index]);
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
  for (const std::string& path : paths) {
    auto model = load_model_file(path, "give it with --recording");
    if (!model) return model.error();
    models.push_back({(*model)->name(), *model});
  }
  std::vector<std::string> names = given;
  for (std::size_t i = 0; given.empty() && i < models.size(); ++i) {
    const bool unique = std::ranges::count(models, models[i].name, &LoadedModel::name) == 1;
    names.push_back(unique ? models[i].name : std::filesystem::path(paths[i]).stem().string());
  }
  names = distinct_names(names);
  for (std::size_t i = 0; i < names.size(); ++i) models[i].name = names[i];
  return models;
}

Status draw_replay(const std::string& path, const std::string& recording, const std::vector<LoadedModel>& models,
                   const std::vector<ComparedMoment>& moments, const std::vector<ErrorSummary>& errors,
                   bool overwrite) {
  std::vector<ComparedModel> compared;
  Panel against;
  against.x.title = "Measured force [N]";
  against.y = {"Mean error + deviation", "N", true};
  against.names_at_ends = true;
  Series jnd{"JND", kMutedColour, Mark::dashed, {}};
  for (std::size_t i = 0; i < models.size(); ++i) {
    const FittedModel& model = *models[i].model;
    compared.push_back({{models[i].name, method_rgb(model.method()), Mark::line, {}}, model.data().jnd});
    Series& series = against.series.emplace_back(compared.back().curve);
    series.mark = Mark::curve;
    for (const ForceBin& bin : errors[i].bins) {
      if (bin.force_N.count() > 0)
        series.rows.push_back({bin.force_N.mean(), bin.error_N.mean() + bin.error_N.deviation()});
      if (i == 0) jnd.rows.push_back({0.5 * (bin.force_from_N + bin.force_to_N), bin.jnd_N});
    }
  }
  merge_equal(against.series);
  against.series.push_back(std::move(jnd));
  Plot plot;
  plot.name = "replay";
  plot.height = 0.7;
  plot.panels = compared_forces(recording, compared, moments);
  plot.panels.push_back(std::move(against));
  return draw_plot(plot, path, overwrite);
}

}  // namespace palpate::cli
