// Models against one recording, through the tick of the live loop, sixteen at a time: errors with positions
// as recorded, and with the surface moved to where the models have theirs. Every model says itself where the
// surface is (models/surface/surface_search.h), or some say it for all; the moved figures come from the
// same rows, each position less the offset, and their own samples in contact.
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/replay.h"
#include "models/surface/surface_search.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/model_timing.h"

namespace palpate {

using ModelPointer = std::shared_ptr<const ForceModel>;

struct EvaluatedModel {
  ModelPointer model;
  JndLine jnd;
};

// The rows of a recording, as often as they are asked for: run through a tick with up to
// kMaxModels models, `surface_offset_m` subtracted from every position.
struct RowSource {
  std::function<Result<ReplaySummary>(const ForceModels& models, const ReplayVisitor& visitor, double surface_offset_m)>
      replay;
};
RowSource rows_of(const Recording& recording);    // which outlives it
RowSource rows_of_file(const std::string& path);  // in bounded memory

struct EvaluationRequest {
  // Sees every row as recorded, with the first kMaxModels models.
  ReplayVisitor also;
  // Rows outside are replayed, since the material remembers them, but do not count.
  Interval counted_s{-1e300, 1e300};
  bool move_surface = true;
  // The models that say together where the surface is, for all; empty: each for itself.
  std::vector<ModelPointer> surface_models;
  FitControl control;
};

// The predicted 95 % bounds against the errors; NaN for a model without.
struct PredictedErrors {
  double held_share = std::numeric_limits<double>::quiet_NaN();
  double median_N = std::numeric_limits<double>::quiet_NaN();
};

struct ModelEvaluation {
  ModelErrors as_recorded;
  ModelErrors surface_moved;
  PredictedErrors predicted;  // with the surface moved
  OffsetEstimate surface;     // identified or not
};

struct RecordingEvaluation {
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  std::vector<ModelEvaluation> models;
  ModelErrors no_force{JndLine{}};  // of a model that always says 0 N, as recorded, at the first model's JND
  TimedSamples timing;              // to time models on
};

// One evaluation a model, in their order. Errors: those of the rows; interrupted.
Result<RecordingEvaluation> evaluate(const RowSource& rows, const std::vector<EvaluatedModel>& models,
                                     const EvaluationRequest& request = {});

}  // namespace palpate
