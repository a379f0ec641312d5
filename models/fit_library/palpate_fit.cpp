// The C interface of models/library/palpate/palpate_fit.h.
#include "models/library/palpate/palpate_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/import/import_table.h"
#include "engine/recording/recording.h"
#include "engine/recording/recording_rules.h"
#include "models/check/check_recording.h"
#include "models/fit_library/fit_recordings.h"
#include "models/library/c_interface.h"
#include "models/model/file/model_io.h"
#include "models/training/motion_source.h"

struct palpate_recording {
  palpate::Recording recording;
  std::vector<bool> left_out{};
};

// A row of the interface has the layout of a row of a recording.
static_assert(sizeof(palpate_row) == sizeof(palpate::RecordingRow) &&
              offsetof(palpate_row, acceleration_m_per_s2) == offsetof(palpate::RecordingRow, acceleration_m_per_s2));

namespace palpate::library {
namespace {

// The scene of fits without a scene file: the features of Hoever & Harders (2009).
constexpr const char* kSceneFeatures = "depth,velocity,lowpass_velocity:0.17,lowpass_velocity:1.27";

std::string findings_of(const RecordingCheck& check) {
  std::string text;
  for (const Finding& finding : check.findings) {
    text += std::string(severity_name(finding.severity)) + " " + finding_text(finding) + "\n";
  }
  return text;
}

void set(std::string& option, const char* text) {
  if (text != nullptr) option = text;
}

FitOptions options_of(const palpate_fit_options& given) {
  FitOptions options;
  set(options.method, given.method);
  set(options.candidates, given.candidates);
  set(options.kernel, given.kernel);
  set(options.weighting, given.weighting);
  set(options.reduction, given.reduction);
  set(options.recipe, given.recipe);
  set(options.features, given.features);
  set(options.relaxation, given.relaxation);
  set(options.surface, given.surface);
  set(options.grid, given.grid);
  options.centres = given.centres;
  options.seed = given.seed;
  return options;
}

Result<TrainingRequest> scene_of(const palpate_fit_options& given) {
  TrainingRequest scene;
  scene.scene = given.scene == nullptr ? "silicone_block" : given.scene;
  scene.jnd = {given.jnd_offset_N, given.jnd_weber_fraction};
  if (!(scene.jnd.offset_N > 0.0 && scene.jnd.weber_fraction >= 0.0) || !std::isfinite(scene.jnd.at(1.0)))
    return Error{"jnd_offset_N, jnd_weber_fraction: found " + std::to_string(scene.jnd.offset_N) + " and " +
                 std::to_string(scene.jnd.weber_fraction) + ", expected more than 0 N, and 0 or more"};
  auto features = parse_scene_features(given.scene_features == nullptr ? kSceneFeatures : given.scene_features);
  if (!features) return Error{"scene_features: " + features.error().message};
  scene.features = std::move(*features);
  scene.choice = FeatureChoice::automatic;
  return scene;
}

palpate_fit_options or_default(const palpate_fit_options* options) {
  palpate_fit_options chosen;
  palpate_fit_options_default(&chosen);
  return options == nullptr ? chosen : *options;
}

// `check`: returns the checked recordings for a request.
template <typename Check>
Result<RecordingsFit> fit_checked(const palpate_fit_options& given, const Check& check) {
  const auto began = std::chrono::steady_clock::now();
  const FitOptions options = options_of(given);
  if (Status status = check_fit_options(options); !status) return status.error();
  const auto scene = scene_of(given);
  if (!scene) return scene.error();
  Result<std::vector<CheckedFile>> checked = check(check_request(scene->jnd, scene->features));
  if (!checked) return checked.error();
  if (Status status = refuse_unusable(*checked); !status) return status.error();
  std::function<bool(double)> progress;
  if (given.progress != nullptr)
    progress = [&given](double fraction) { return given.progress(fraction, given.context) != 0; };
  return fit_recordings(std::move(*checked), *scene, options, began, progress);
}

template <typename Item>
bool all_given(const Item* const* items, std::size_t count) {
  return items != nullptr && count > 0 && std::find(items, items + count, nullptr) == items + count;
}

Result<Recording> recording_of(std::string name, std::size_t n, const double* time_s, const double* position_m,
                               const double* force_N, const double* velocity_m_per_s,
                               const double* acceleration_m_per_s2) {
  Recording recording{std::move(name), {velocity_m_per_s != nullptr, acceleration_m_per_s2 != nullptr}, {}};
  recording.rows.reserve(n);
  RowRules rules;
  std::optional<RowFault> fault;
  for (std::size_t i = 0; i < n && !fault; ++i) {
    RecordingRow row{time_s[i], position_m[i], force_N[i]};
    if (velocity_m_per_s != nullptr) row.velocity_m_per_s = velocity_m_per_s[i];
    if (acceleration_m_per_s2 != nullptr) row.acceleration_m_per_s2 = acceleration_m_per_s2[i];
    fault = rules.check(row);
    recording.rows.push_back(row);
  }
  if (!fault) fault = rules.finish();
  if (!fault) return recording;
  const bool of_row = fault->place == RowFault::Place::kThisRow;
  return Error{recording.name + (of_row ? ": row " + std::to_string(recording.rows.size() - 1) : std::string()) + ": " +
               fault->text};
}

// Assigns samples, which are in order of recordings, to folds; returns the number of folds.
int assign_folds(std::size_t n, const double* depth_m, const int* recording, int* fold) {
  const auto recording_of = [&](std::size_t i) { return recording == nullptr ? 0 : recording[i]; };
  std::vector<int> stroke(n);
  TrainingExtent extent;
  std::size_t recordings = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = i == 0 || recording_of(i - 1) != recording_of(i);
    recordings += first ? 1 : 0;
    stroke[i] = static_cast<int>(extent.strokes);
    if (!first)
      (depth_m[i] > depth_m[i - 1] ? extent.loading_path_m : extent.unloading_path_m) +=
          std::abs(depth_m[i] - depth_m[i - 1]);
    if (!(depth_m[i] > 0.0)) continue;
    if (first || !(depth_m[i - 1] > 0.0)) stroke[i] = static_cast<int>(++extent.strokes);
    ++extent.contact_samples;
  }
  FoldAssignment assignment = extent.folds(recordings);
  for (std::size_t i = 0; i < n; ++i) fold[i] = assignment.next(recording_of(i), stroke[i], depth_m[i] > 0.0);
  return assignment.folds();
}

}  // namespace
}  // namespace palpate::library

using palpate::Error;
using palpate::Result;
using palpate::Status;
using palpate::library::made;
using palpate::library::status_of;

palpate_recording* palpate_recording_load(const char* path, char* error, size_t error_size) {
  return made<palpate_recording>(error, error_size, [&]() -> Result<palpate_recording*> {
    if (path == nullptr) return Error{"found no path, expected that of a recording"};
    auto recording = palpate::read_recording(path);
    if (!recording) return recording.error();
    return new palpate_recording{std::move(*recording)};
  });
}

palpate_recording* palpate_recording_new(const char* name, size_t n, const double* time_s, const double* position_m,
                                         const double* force_N, const double* velocity_m_per_s,
                                         const double* acceleration_m_per_s2, const unsigned char* left_out,
                                         char* error, size_t error_size) {
  return made<palpate_recording>(error, error_size, [&]() -> Result<palpate_recording*> {
    if (name == nullptr || time_s == nullptr || position_m == nullptr || force_N == nullptr)
      return Error{"found no name, time, position or force, expected all of them"};
    auto recording =
        palpate::library::recording_of(name, n, time_s, position_m, force_N, velocity_m_per_s, acceleration_m_per_s2);
    if (!recording) return recording.error();
    std::vector<bool> left(left_out, left_out == nullptr ? nullptr : left_out + n);
    return new palpate_recording{std::move(*recording), std::move(left)};
  });
}

void palpate_recording_free(palpate_recording* recording) { delete recording; }

const char* palpate_recording_name(const palpate_recording* recording) {
  return recording == nullptr ? "" : recording->recording.name.c_str();
}

int palpate_recording_has_velocity(const palpate_recording* recording) {
  return recording != nullptr && recording->recording.columns.velocity ? 1 : 0;
}

int palpate_recording_has_acceleration(const palpate_recording* recording) {
  return recording != nullptr && recording->recording.columns.acceleration ? 1 : 0;
}

size_t palpate_recording_row_count(const palpate_recording* recording) {
  return recording == nullptr ? 0 : recording->recording.rows.size();
}

const palpate_row* palpate_recording_rows(const palpate_recording* recording) {
  return recording == nullptr ? nullptr : reinterpret_cast<const palpate_row*>(recording->recording.rows.data());
}

int palpate_import(const char* table, const char* recording, int overwrite, char* error, size_t error_size) {
  return status_of(error, error_size, [&]() -> Status {
    if (table == nullptr || recording == nullptr) return Error{"found no path, expected a table and a recording"};
    const auto imported = palpate::import_table(table, {});
    if (!imported) return imported.error();
    return palpate::write_recording(recording, imported->recording, imported->notes, overwrite != 0);
  });
}

int palpate_check(const char* recording, palpate_check_result* result, char* findings, size_t findings_size,
                  char* error, size_t error_size) {
  return status_of(error, error_size, [&]() -> Status {
    if (recording == nullptr || result == nullptr) return Error{"found no path or no result, expected both"};
    const auto features = palpate::parse_scene_features(palpate::library::kSceneFeatures);
    const auto file = palpate::check_recording_file(recording, palpate::check_request({}, *features));
    if (!file) return file.error();
    const palpate::RecordingCheck& check = file->check;
    *result = {2 - static_cast<int>(check.gravest()), check.noise_floor_within_jnd, check.surface_offset_m,
               check.force_zero_N};
    palpate::library::TextBuffer{findings, findings_size}.write(palpate::library::findings_of(check));
    return {};
  });
}

void palpate_fit_options_default(palpate_fit_options* options) {
  if (options == nullptr) return;
  const palpate::JndLine jnd;
  *options = {};
  options->centres = palpate::FitOptions{}.centres;
  options->seed = palpate::FitOptions{}.seed;
  options->jnd_offset_N = jnd.offset_N;
  options->jnd_weber_fraction = jnd.weber_fraction;
}

palpate_model* palpate_fit_recordings(const palpate_recording* const* recordings, size_t recording_count,
                                      const palpate_fit_options* options, char* error, size_t error_size) {
  return made<palpate_model>(error, error_size, [&]() -> Result<palpate_model*> {
    if (!palpate::library::all_given(recordings, recording_count))
      return Error{"found no recording, expected one or more"};
    const palpate_fit_options chosen = palpate::library::or_default(options);
    auto fitted = palpate::library::fit_checked(chosen, [&](const palpate::CheckRequest& request) {
      std::vector<palpate::CheckedFile> checked;
      for (const palpate_recording* one : std::span(recordings, recording_count)) {
        const auto prepared = palpate::prepare_recording(one->recording, one->left_out);
        checked.push_back({one->recording.name, prepared, true, palpate::check_recording(*prepared, request)});
      }
      return Result<std::vector<palpate::CheckedFile>>(std::move(checked));
    });
    if (!fitted) return fitted.error();
    const std::string report = palpate::fit_json(*fitted, palpate::library::options_of(chosen)).dump();
    return new palpate_model(std::make_shared<const palpate::FittedModel>(std::move(fitted->fit.data)), report);
  });
}

int palpate_fit(const char* const* recordings, size_t recording_count, const palpate_fit_options* options,
                const char* model, char* error, size_t error_size) {
  return status_of(error, error_size, [&]() -> Status {
    if (!palpate::library::all_given(recordings, recording_count) || model == nullptr)
      return Error{"found no path, expected recordings and a model to write"};
    const std::vector<std::string> paths(recordings, recordings + recording_count);
    const palpate_fit_options chosen = palpate::library::or_default(options);
    const auto fitted = palpate::library::fit_checked(
        chosen, [&](const palpate::CheckRequest& request) { return palpate::check_recording_files(paths, request); });
    if (!fitted) return fitted.error();
    return palpate::save_model(model, fitted->fit.data, chosen.overwrite != 0);
  });
}

int palpate_folds(size_t n, const double* depth_m, const int* recording, int* fold) {
  if (depth_m == nullptr || fold == nullptr) return -1;
  return palpate::library::guarded<int>(
      -1, {}, [&]() -> Result<int> { return palpate::library::assign_folds(n, depth_m, recording, fold); });
}
