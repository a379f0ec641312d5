#include "scenes/cli/replayed_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "models/model/file/model_io.h"
#include "models/surface/surface_search.h"
#include "scenes/cli/forces_file.h"

namespace palpate::cli {
namespace {

constexpr double kShareThatMatters = 0.005;
constexpr double kRmsThatMatters = 0.1;

// One pass over the recording, its errors model by model.
class ErrorPass {
 public:
  explicit ErrorPass(const std::vector<LoadedModel>& models) : features_(models.size()), bounds_(models.size()) {
    for (const LoadedModel& one : models) statistics_.emplace_back(one.model->data().jnd);
  }

  void add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
    if (!snapshot.in_contact) return;
    for (std::size_t i = 0; i < statistics_.size(); ++i) {
      statistics_[i].add(snapshot.force_N[i], row.force_N, (snapshot.out_of_domain_mask >> i & 1U) != 0);
      features_[i].add(tick.features_of(i));
      const double bound_N = snapshot.predicted_error_N[i];
      if (std::isnan(bound_N)) continue;
      bounds_[i].bound_N.push_back(static_cast<float>(bound_N));
      if (std::abs(snapshot.force_N[i] - row.force_N) <= bound_N) ++bounds_[i].held;
    }
  }

  ErrorSummary errors(std::size_t model) const { return statistics_[model].summary(); }
  const FeatureSample& features(std::size_t model) const { return features_[model]; }

  BoundSummary bound(std::size_t model) const {
    std::vector<float> all = bounds_[model].bound_N;
    if (all.empty()) return {std::nan(""), std::nan("")};
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return {static_cast<double>(bounds_[model].held) / static_cast<double>(all.size()), *middle};
  }

 private:
  struct Bounds {
    std::vector<float> bound_N;
    std::size_t held = 0;
  };
  std::vector<ErrorStatistics> statistics_;
  std::vector<FeatureSample> features_;
  std::vector<Bounds> bounds_;
};

Result<ReplaySummary> run_pass(const std::string& path, const ForceModels& models, const ReplayVisitor& visitor,
                               double surface_offset_m) {
  Result<RecordingReader> reader = RecordingReader::open(path);
  if (!reader) return reader.error();
  return replay(*reader, models, visitor, surface_offset_m);
}

bool is_recording(const std::string& path) { return RecordingReader::open(path).ok(); }

Error recording_as_model(const std::string& path) {
  return Error{path + " is a recording, expected a model file (JSON, made by palpate fit); give it with --recording"};
}

// Models of one name by their files.
std::vector<std::string> told_apart(const std::vector<std::string>& names, const std::vector<std::string>& paths) {
  std::vector<std::string> result = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::count(names.begin(), names.end(), names[i]) > 1) result[i] = std::filesystem::path(paths[i]).stem().string();
  }
  return result;
}

}  // namespace

Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& given) {
  if (paths.size() > kMaxModels) {
    return Error{"found " + std::to_string(paths.size()) + " models, expected at most " +
                 std::to_string(kMaxModels) + "; replay them in several runs"};
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

Result<ReplayedRecording> replay_recording(const std::string& path, const std::vector<LoadedModel>& models,
                                           const std::string& forces_path, bool overwrite,
                                           const ReplayVisitor& also) {
  ForceModels force_models;
  std::vector<std::string> names;
  for (const LoadedModel& one : models) {
    force_models.push_back(one.model);
    names.push_back(one.name);
  }
  std::optional<ForcesFile> forces;
  if (!forces_path.empty()) {
    Result<ForcesFile> file = ForcesFile::create(forces_path, overwrite, force_models, names);
    if (!file) return file.error();
    forces.emplace(std::move(*file));
  }
  ErrorPass as_recorded(models);
  GrowingStride rows(2 * kSearchRows);
  const auto summary = run_pass(path, force_models, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
    if (forces) forces->add(row, snapshot, tick);
    rows.add({{row.time_s, row.position_m, row.velocity_m_per_s, row.acceleration_m_per_s2}, tick.motion(), row.force_N});
    as_recorded.add(row, snapshot, tick);
    if (also) also(row, snapshot, tick);
  }, 0.0);
  if (!summary) return summary.error();
  if (forces) {
    if (const Status status = forces->commit(); !status) return status.error();
  }

  const SurfaceLocation surface =
      locate_surface(thinned_rows(rows.rows(), kSearchRows), force_models, models.front().model->data().jnd);
  std::optional<ErrorPass> moved;
  if (surface.offset_m != 0.0) {
    moved.emplace(models);
    const auto again = run_pass(path, force_models, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
      moved->add(row, snapshot, tick);
    }, surface.offset_m);
    if (!again) return again.error();
  }
  ReplayedRecording replayed{path, summary->samples, summary->contact_samples, surface.offset_m,
                             surface.standard_error_m, {}};
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ErrorSummary plain = as_recorded.errors(i);
    replayed.models.push_back(
        {plain, moved ? moved->errors(i) : plain, moved ? moved->bound(i) : as_recorded.bound(i),
         time_model(*models[i].model, as_recorded.features(i))});
  }
  return replayed;
}

std::string surface_remark(const ReplayedRecording& replayed, const std::vector<LoadedModel>& models) {
  std::size_t most = models.size();
  double largest = 0.0;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ErrorSummary& plain = replayed.models[i].as_recorded;
    const ErrorSummary& moved = replayed.models[i].surface_moved;
    const double share = std::abs(moved.within_jnd - plain.within_jnd);
    const bool matters = share > kShareThatMatters ||
                         std::abs(moved.rms_error_N - plain.rms_error_N) > kRmsThatMatters * plain.rms_error_N;
    if (!matters || (most < models.size() && share <= largest)) continue;
    most = i;
    largest = share;
  }
  if (most == models.size()) return {};
  const ErrorSummary& plain = replayed.models[most].as_recorded;
  const ErrorSummary& moved = replayed.models[most].surface_moved;
  char text[320];
  std::snprintf(text, sizeof text,
                "the surface of this recording lies at %+.3f mm for these models, and that decides the figures: %s has "
                "%.2f %% within the JND and %.1f mN RMS as recorded, %.2f %% and %.1f mN with the surface moved",
                1e3 * replayed.surface_offset_m, models[most].name.substr(0, 64).c_str(), 1e2 * plain.within_jnd,
                1e3 * plain.rms_error_N, 1e2 * moved.within_jnd, 1e3 * moved.rms_error_N);
  return text;
}

}  // namespace palpate::cli
