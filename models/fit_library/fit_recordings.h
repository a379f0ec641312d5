// Checked recordings in, a fitted model out: what `palpate fit` and the C interface share.
// Thread guarantee: slow side.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/check/check_recording.h"
#include "models/fit/fit.h"
#include "models/fit_library/fit_options.h"

namespace palpate {

struct RecordingsFit {
  PreparedTraining prepared;
  MethodFit fit;
  double seconds = 0.0;
};

// `scene`: as training_request. `began`: the beginning of what counts as seconds. `progress`: called with the fraction
// done, returns false to stop; may be empty. Errors: an option; those of the recordings and of the fit; interrupted.
Result<RecordingsFit> fit_recordings(std::vector<CheckedFile> recordings, const TrainingRequest& scene,
                                     const FitOptions& options, std::chrono::steady_clock::time_point began,
                                     const std::function<bool(double)>& progress);

// The contract's object of `palpate fit --json`.
nlohmann::ordered_json fit_json(const RecordingsFit& fitted, const FitOptions& options);

}  // namespace palpate
