// Fits a model to checked recordings, for `palpate fit` and the C interface.
// Thread guarantee: slow side.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/base/result.h"
#include "models/check/check_recording.h"
#include "models/fit/fit.h"

namespace palpate {

struct RecordingsFit {
  std::vector<PartGain> gains;  // as in PreparedTraining
  std::optional<CorrectionChoice> correction;
  MethodFit fit;
  double seconds = 0.0;
};

// `began`: the time from which `seconds` are counted. `progress`: called with the finished fraction, returns false to
// interrupt; may be empty. Errors: those of the fit; interrupted.
Result<RecordingsFit> fit_recordings(std::vector<CheckedFile> recordings, const TrainingScene& scene,
                                     const ModelPlan& plan, std::chrono::steady_clock::time_point began,
                                     const std::function<bool(double)>& progress);
// The JSON object that `palpate fit --json` prints.
nlohmann::ordered_json fit_json(const RecordingsFit& fitted);

}  // namespace palpate
