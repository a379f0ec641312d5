// The C interface of models/library/palpate/palpate_fit.h.
#include "models/library/palpate/palpate_fit.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/import/import_table.h"
#include "engine/recording/recording.h"
#include "models/check/check_recording.h"
#include "models/fit/fit.h"
#include "models/library/error_text.h"
#include "models/model/file/model_io.h"

struct palpate_recording {
  std::vector<palpate_row> rows;
};

namespace palpate::library {
namespace {

// What `palpate fit` takes when nothing is said: the features of Hoever & Harders (2009)
// as a candidate beside those that the recordings support.
TrainingRequest default_training() {
  TrainingRequest request;
  request.scene = "silicone_block";
  request.features.resize(4);
  request.features[1].kind = FeatureKind::velocity;
  request.features[2].kind = FeatureKind::lowpass_velocity;
  request.features[2].relaxation_time_s = 0.17;
  request.features[3].kind = FeatureKind::lowpass_velocity;
  request.features[3].relaxation_time_s = 1.27;
  request.choice = FeatureChoice::automatic;
  return request;
}

CheckRequest default_check() { return {JndLine{}, {0.17, 1.27}}; }

Status import_to(const std::string& table, const std::string& recording, bool overwrite) {
  const auto imported = import_table(table, {});
  if (!imported) return imported.error();
  return write_recording(recording, imported->recording, imported->notes, overwrite);
}

palpate_check_result result_of(const RecordingCheck& check) {
  const std::string verdict = check.verdict();
  return {verdict == "usable" ? 2
          : verdict == "care" ? 1
                              : 0,
          check.noise_floor_within_jnd, check.surface_offset_m, check.force_zero_N};
}

std::string findings_of(const RecordingCheck& check) {
  std::string text;
  for (const Finding& finding : check.findings) {
    text += std::string(severity_name(finding.severity)) + " " + finding.code + ": " + finding.text +
            (finding.advice.empty() ? "" : "; " + finding.advice) + "\n";
  }
  return text;
}

Result<MethodRequest> method_request(const palpate_fit_options& options) {
  MethodRequest request;
  request.method = options.method == nullptr ? nullptr : find_method(options.method);
  if (request.method == nullptr) {
    return Error{"method: found \"" + std::string(options.method == nullptr ? "" : options.method) +
                 "\", expected one of " + method_names()};
  }
  if (options.centres < 1 || options.centres > 100000) {
    return Error{"centres: found " + std::to_string(options.centres) + ", expected 1 to 100000"};
  }
  request.centres = options.centres;
  request.seed = options.seed;
  return request;
}

// `begin` to `end`: the part of the whole that this step is.
FitControl control_of(const palpate_fit_options& options, double begin, double end) {
  FitControl control;
  if (options.progress == nullptr) return control;
  control.progress = [=](double fraction) {
    return options.progress(begin + (end - begin) * fraction, options.context) != 0;
  };
  return control;
}

Status fit_to(const std::vector<std::string>& recordings, const palpate_fit_options& options,
              const std::string& model) {
  const auto method = method_request(options);
  if (!method) return method.error();
  auto checked = check_recording_files(recordings, default_check());
  if (!checked) return checked.error();
  if (Status status = refuse_unusable(*checked); !status) return status;
  MotionSource source(training_inputs(std::move(*checked)));
  const auto prepared = prepare_training(source, default_training(), control_of(options, 0.0, 0.3));
  if (!prepared) return prepared.error();
  const auto fit = fit_method(*prepared, *method, control_of(options, 0.3, 1.0));
  if (!fit) return fit.error();
  return save_model(model, fit->data, options.overwrite != 0);
}

int reported(const Place& place, const Status& status) {
  if (status) return 0;
  place.fail(status.error().message);
  return -1;
}

}  // namespace
}  // namespace palpate::library

using palpate::library::guarded;
using palpate::library::Place;

palpate_recording* palpate_recording_load(const char* path, char* error, size_t error_size) {
  return guarded<palpate_recording*>(nullptr, {error, error_size}, [&](Place place) -> palpate_recording* {
    if (path == nullptr) return place.fail("found no path, expected that of a recording");
    const auto recording = palpate::read_recording(path);
    if (!recording) return place.fail(recording.error().message);
    auto handle = std::make_unique<palpate_recording>();
    handle->rows.reserve(recording->rows.size());
    for (const palpate::RecordingRow& row : recording->rows) {
      handle->rows.push_back(
          {row.time_s, row.position_m, row.force_N, row.velocity_m_per_s, row.acceleration_m_per_s2});
    }
    return handle.release();
  });
}

void palpate_recording_free(palpate_recording* recording) { delete recording; }

size_t palpate_recording_row_count(const palpate_recording* recording) {
  return recording == nullptr ? 0 : recording->rows.size();
}

const palpate_row* palpate_recording_rows(const palpate_recording* recording) {
  return recording == nullptr ? nullptr : recording->rows.data();
}

int palpate_import(const char* table, const char* recording, int overwrite, char* error, size_t error_size) {
  return guarded<int>(-1, {error, error_size}, [&](Place place) {
    if (table == nullptr || recording == nullptr) {
      return palpate::library::reported(place, palpate::Error{"found no path, expected a table and a recording"});
    }
    return palpate::library::reported(place, palpate::library::import_to(table, recording, overwrite != 0));
  });
}

int palpate_check(const char* recording, palpate_check_result* result, char* findings, size_t findings_size,
                  char* error, size_t error_size) {
  return guarded<int>(-1, {error, error_size}, [&](Place place) {
    if (recording == nullptr || result == nullptr) {
      return palpate::library::reported(place, palpate::Error{"found no path or no result, expected both"});
    }
    const auto file = palpate::check_recording_file(recording, palpate::library::default_check());
    if (!file) return palpate::library::reported(place, file.error());
    *result = palpate::library::result_of(file->check);
    Place{findings, findings_size}.fail(palpate::library::findings_of(file->check));
    return 0;
  });
}

void palpate_fit_options_default(palpate_fit_options* options) {
  if (options != nullptr) *options = {"greedy", 100, 1, 0, nullptr, nullptr};
}

int palpate_fit(const char* const* recordings, size_t recording_count, const palpate_fit_options* options,
                const char* model, char* error, size_t error_size) {
  return guarded<int>(-1, {error, error_size}, [&](Place place) {
    std::vector<std::string> paths;
    for (size_t i = 0; recordings != nullptr && i < recording_count; ++i) {
      if (recordings[i] != nullptr) paths.emplace_back(recordings[i]);
    }
    if (paths.empty() || paths.size() != recording_count || model == nullptr) {
      return palpate::library::reported(place,
                                        palpate::Error{"found no path, expected recordings and a model to write"});
    }
    palpate_fit_options chosen;
    palpate_fit_options_default(&chosen);
    if (options != nullptr) chosen = *options;
    return palpate::library::reported(place, palpate::library::fit_to(paths, chosen, model));
  });
}
