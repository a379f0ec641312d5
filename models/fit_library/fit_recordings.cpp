#include "models/fit_library/fit_recordings.h"

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/recording/recording.h"
#include "models/library/c_interface.h"
#include "models/library/palpate/palpate_fit.h"
#include "models/samples/recording_faults.h"

namespace palpate {
namespace {

// The approximate time of the preparation, to compare with the expected time of the method.
constexpr double kPreparation_s = 0.5;

}  // namespace

Result<RecordingsFit> fit_recordings(std::vector<CheckedFile> recordings, const TrainingScene& scene,
                                     const ModelPlan& plan, std::chrono::steady_clock::time_point began,
                                     const std::function<bool(double)>& progress) {
  ModelFits fits(training_recordings(std::move(recordings)), scene);
  const FitControl control{progress};
  const double prepared_at = kPreparation_s / (kPreparation_s + expected_seconds(*plan.method));
  const auto prepared = fits.prepare(plan, control.part(0.0, prepared_at));
  if (!prepared) return prepared.error();
  auto fit = fits.fit(plan, control.part(prepared_at, 1.0));
  if (!fit) return fit.error();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return RecordingsFit{(*prepared)->gains, (*prepared)->correction, std::move(*fit), seconds};
}

nlohmann::ordered_json fit_json(const RecordingsFit& fitted) {
  const MethodFit& fit = fitted.fit;
  const ModelData& data = fit.data;
  nlohmann::ordered_json features = nlohmann::ordered_json::array(), recordings = features;
  for (const FeatureSpec& spec : data.features) features.push_back(feature_name(spec));
  for (const RecordingOffset& one : data.provenance.offsets) {
    recordings.push_back({{"name", one.name},
                          {"surface_offset_m", one.offset_m},
                          {"standard_error_m", one.standard_error_m},  // not finite: null
                          {"identified", std::isfinite(one.standard_error_m)},
                          {"force_zero_N", one.force_zero_N}});
  }
  return {{"name", data.name},
          {"method", data.method},
          {"centres", data.centre_count()},
          {"kernel", kernel_name(fit.kernel)},
          {"weighting", data.provenance.weighting},
          {"samples", data.provenance.samples},
          {"samples_after_reduction", data.provenance.samples_after_reduction},
          {"rank", fit.rank},
          {"condition_number", fit.condition_number},
          {"fit_seconds", fitted.seconds},
          {"training_within_jnd", data.provenance.training_within_jnd},
          {"features", features},
          {"recordings", recordings},
          {"notes", fit.notes}};
}

}  // namespace palpate

// The C interface of models/library/palpate/palpate_fit.h.
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
  return CheckedFile{prepared->recording.name, prepared, true, check_recording(*prepared, request, faults)};
}

}  // namespace
}  // namespace palpate::library

using namespace palpate;

palpate_model* palpate_fit(const palpate_recording* recordings, size_t recording_count, const char* options,
                           int (*progress)(double fraction, void* context), void* context, char* error,
                           size_t error_size) {
  return library::made<palpate_model>(error, error_size, [&]() -> Result<palpate_model*> {
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
    std::function<bool(double)> report;
    if (progress != nullptr) report = [&](double fraction) { return progress(fraction, context) != 0; };
    auto fitted = fit_recordings(std::move(files), scene, *plan, began, report);
    if (!fitted) return fitted.error();
    const std::string figures = fit_json(*fitted).dump();
    return new palpate_model(std::make_shared<const FittedModel>(std::move(fitted->fit.data)), figures);
  });
}
