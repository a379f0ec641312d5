// The C interface of models/library/palpate/palpate_fit.h.
#include "models/library/palpate/palpate_fit.h"

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "engine/recording/recording.h"
#include "models/check/check_recording.h"
#include "models/fit/fit.h"
#include "models/library/c_interface.h"
#include "models/samples/samples.h"

namespace palpate::library {
namespace {

// The scene of a fit without a scene file: the features of Hoever & Harders (2009).
TrainingScene default_scene() {
  TrainingScene scene;
  scene.name = "silicone_block";
  scene.features = {{.kind = FeatureKind::depth},
                    {.kind = FeatureKind::velocity},
                    {.kind = FeatureKind::lowpass_velocity, .relaxation_time_s = 0.17},
                    {.kind = FeatureKind::lowpass_velocity, .relaxation_time_s = 1.27}};
  return scene;
}

// Checks the samples by the rules of a recording file. Errors: the first broken rule, with its row.
Status check_rows(const Recording& recording) {
  RowRules rules;
  std::optional<RowFault> fault;
  for (std::size_t i = 0; i < recording.rows.size() && !fault; ++i) fault = rules.check(recording.rows[i]);
  if (!fault) fault = rules.finish();
  if (!fault) return {};
  const bool of_row = fault->place == RowFault::Place::kThisRow;
  return Error{recording.name + (of_row ? ": row " + std::to_string(rules.rows()) : std::string()) + ": " +
               fault->text};
}

// As check_recording_file, for a recording in memory.
Result<CheckedFile> checked(const palpate_recording& given, const CheckRequest& request) {
  if (given.time_s == nullptr || given.position_m == nullptr || given.force_N == nullptr)
    return Error{std::string(given.name == nullptr ? "" : given.name) +
                 ": found no time, position or force, expected all of them"};
  Recording recording = recording_of(given);
  if (Status status = check_rows(recording); !status) return status.error();
  const RecordingFaults faults = remove_faults(recording);
  const auto prepared = prepare_recording(std::move(recording));
  return CheckedFile{prepared->recording.name, prepared, check_recording(*prepared, request, faults)};
}

}  // namespace
}  // namespace palpate::library

using namespace palpate;

palpate_model* palpate_fit(const palpate_recording* recordings, size_t recording_count, const char* options,
                           int (*progress)(double fraction, void* context), void* context, char* error,
                           size_t error_size) {
  return library::made<palpate_model*>(nullptr, error, error_size, [&]() -> Result<palpate_model*> {
    const auto began = std::chrono::steady_clock::now();
    if (recordings == nullptr || recording_count == 0) return Error{"found no recording, expected one or more"};
    const auto plan = parse_plan_options(options == nullptr ? "" : options);
    if (!plan) return plan.error();
    const TrainingScene scene = library::default_scene();
    std::vector<CheckedFile> files;
    for (size_t i = 0; i < recording_count; ++i) {
      auto file = library::checked(recordings[i], check_request(scene.jnd, scene.features));
      if (!file) return file.error();
      files.push_back(std::move(*file));
    }
    if (Status status = refuse_unusable(files); !status) return status.error();
    FitControl control;
    if (progress != nullptr) control.progress = [&](double fraction) { return progress(fraction, context) != 0; };
    auto fitted = ModelFits(training_recordings(std::move(files)), scene).fit(*plan, control);
    if (!fitted) return fitted.error();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - began;
    const std::string figures = fit_json(*fitted, elapsed.count()).dump();
    return new palpate_model(fitted->model, figures);
  });
}
