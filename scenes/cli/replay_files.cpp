#include "scenes/cli/replay_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/tick/haptics_tick.h"
#include "scenes/cli/shared.h"
#include "scenes/plot/draw.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {
namespace {

bool same_rows(const Series& one, const Series& other) {
  return std::ranges::equal(one.rows, other.rows, [](const PlotRow& a, const PlotRow& b) {
    return a.y == b.y || (std::isnan(a.y) && std::isnan(b.y));
  });
}

// Merges curves that are equal, because only one of them would be visible. Areas stay.
void merge_equal(std::vector<Series>& series) {
  for (std::size_t i = series.size(); i-- > 0;) {
    for (std::size_t k = 0; k < i; ++k) {
      if (series[k].mark == Mark::area || !same_rows(series[i], series[k])) continue;
      series[k].name += ", " + series[i].name;
      series.erase(series.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  }
}

constexpr std::size_t kMostMoments = 3000;
constexpr double kLeastScale_jnd = 1.6;
constexpr double kMostScale_jnd = 5.0;

}  // namespace

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
      forces.columns_.push_back({m, i});
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
  for (const FeatureColumn& column : columns_) append(tick.features_of(column.model).values[column.index]);
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

void ReplayPlot::add(const RecordingRow& row, const TickSnapshot& snapshot) {
  Moment moment{row.time_s, row.force_N, snapshot.in_contact, {}};
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const JndLine& jnd = models_[i].model->data().jnd;
    moment.over_jnd.push_back(static_cast<float>((snapshot.force_N[i] - row.force_N) / jnd.at(row.force_N)));
  }
  moments_.push_back(std::move(moment));
}

Status ReplayPlot::draw(const std::string& path, const std::string& recording, const std::vector<ErrorSummary>& errors,
                        bool overwrite) const {
  Plot plot;
  plot.name = "replay";
  plot.height = 0.7;
  Panel force;
  force.title = recording;
  force.y.title = "Force [N]";
  force.series = {{"measured", kMeasuredColour, Mark::line, {}}};
  Panel difference;
  difference.y.title = "Difference [JND]";
  difference.series = {{"within 1 JND", kMutedColour, Mark::area, {}}};
  force.names_at_ends = difference.names_at_ends = true;
  for (const LoadedModel& one : models_) {
    difference.series.push_back({one.name, method_rgb(one.model->method()), Mark::line, {}});
  }
  double largest = kLeastScale_jnd;
  const std::size_t group = moments_.size() / kMostMoments + 1;
  const auto worst_of = [](const Moment& moment) {
    float worst = 0.0F;
    for (const float over : moment.over_jnd) worst = std::max(worst, std::abs(over));
    return moment.in_contact ? static_cast<double>(worst) : -1.0;
  };
  // Draws the moment with the largest error of each group, so that a bad sample is visible.
  for (std::size_t first = 0; first < moments_.size(); first += group) {
    const auto begin = moments_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = moments_.begin() + static_cast<std::ptrdiff_t>(std::min(first + group, moments_.size()));
    const Moment& shown = *std::ranges::max_element(begin, end, {}, worst_of);
    largest = std::max(largest, 1.1 * worst_of(shown));
    force.series[0].rows.push_back({shown.time_s, shown.measured_N});
    difference.series[0].rows.push_back({shown.time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < models_.size(); ++i) {
      const double over = static_cast<double>(shown.over_jnd[i]);
      difference.series[i + 1].rows.push_back({shown.time_s, shown.in_contact ? over : kNoValue});
    }
  }
  merge_equal(difference.series);
  difference.y.high = std::min(largest, kMostScale_jnd);
  difference.y.low = -difference.y.high;
  difference.x.title = "Time [s]";
  Panel against;
  against.x.title = "Measured force [N]";
  against.y = {"Mean error + deviation", "N", true};
  against.names_at_ends = true;
  Series jnd{"JND", kMutedColour, Mark::dashed, {}};
  for (std::size_t i = 0; i < models_.size(); ++i) {
    Series series{models_[i].name, method_rgb(models_[i].model->method()), Mark::curve, {}};
    for (const ForceBin& bin : errors[i].bins) {
      if (bin.force_N.count() > 0)
        series.rows.push_back({bin.force_N.mean(), bin.error_N.mean() + bin.error_N.deviation()});
      if (i == 0) jnd.rows.push_back({0.5 * (bin.force_from_N + bin.force_to_N), bin.jnd_N});
    }
    against.series.push_back(std::move(series));
  }
  merge_equal(against.series);
  against.series.push_back(std::move(jnd));
  plot.panels = {std::move(force), std::move(difference), std::move(against)};
  return draw_plot(plot, path, overwrite);
}

}  // namespace palpate::cli
