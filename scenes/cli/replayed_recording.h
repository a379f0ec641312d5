// Models against one recording: error figures with positions as recorded and
// with the surface moved to where the models have theirs.
//
// The offset is one for all models (models/surface/surface_search.h). The
// moved figures come from the same tick over the same rows, each position less
// the offset; their contact samples are those with a moved position above 0.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/evaluation.h"
#include "engine/tick/replay.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/model_timing.h"

namespace palpate::cli {

struct LoadedModel {
  std::string name;  // distinct among the models of one run
  std::shared_ptr<const FittedModel> model;
};

// The predicted 95 % bound against the errors; held_share is NaN for a model without.
struct BoundSummary {
  double held_share = 0.0;
  double median_N = 0.0;
};

struct ModelErrors {
  ErrorSummary as_recorded;
  ErrorSummary surface_moved;
  BoundSummary bound;  // with the surface moved
  ModelTiming time;
};

struct ReplayedRecording {
  std::string path;
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  double surface_offset_m = 0.0;
  double surface_error_m = 0.0;     // standard error; infinite: no minimum
  std::vector<ModelErrors> models;  // one for each model
};

// `names`: one for each file, or none; models that then have one name are named by
// their files. Errors: too many models; a file that is no model, or a recording.
Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& names = {});

// `forces_path`: where FORCES.csv goes, as recorded; empty: nowhere. `also` sees every
// row as recorded. Errors: those of the recording; the file exists and `overwrite` is
// false.
Result<ReplayedRecording> replay_recording(const std::string& path, const std::vector<LoadedModel>& models,
                                           const std::string& forces_path, bool overwrite,
                                           const ReplayVisitor& also = {});

// What moving the surface changed, in words; empty where it changes nothing
// that matters (a tenth of the RMS error, or half a percent within the JND).
std::string surface_remark(const ReplayedRecording& replayed, const std::vector<LoadedModel>& models);

}  // namespace palpate::cli
