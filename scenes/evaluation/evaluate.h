// Evaluates models on recordings through the tick of the live loop, kMaxModels at a time. Errors are computed twice:
// with the positions as recorded, and with a surface offset subtracted from every position of a recording. The offset
// is estimated for each model (surface_search.h), or once for all. With the offset, contact is determined anew.
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/replay.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/evaluation/surface_search.h"

namespace palpate {

using ModelPointer = std::shared_ptr<const ForceModel>;

struct EvaluatedModel {
  ModelPointer model;
  JndLine jnd;
};

struct EvaluationRequest {
  // Called for every row, with positions as recorded and the first kMaxModels different models; may be empty.
  ReplayVisitor also;
  // Errors count from this time of the recording on. Earlier rows are replayed because the features have memory.
  double counted_from_s = -std::numeric_limits<double>::infinity();
  const Recording* after = nullptr;  // the recording that this one continues (engine/tick/replay.h)
  bool move_surface = true;  // false: the figures with the surface moved equal those as recorded
  // The models from which one common surface offset is estimated. Empty: each model has its own estimate.
  std::vector<ModelPointer> surface_models;
  FitControl control;
};

// Of one model over all recordings.
struct ModelEvaluation {
  ModelErrors as_recorded, surface_moved;
  std::vector<OffsetEstimate> surfaces;  // of each recording; its offset is 0 if not identified
  int began = kBeganAtRest;              // the last recording (HapticsTick::began)
};

struct Evaluation {
  std::uint64_t samples = 0;
  std::vector<ModelEvaluation> models;
  ModelErrors no_force{JndLine{}};   // of a model that is always 0 N, as recorded, with the JND of the first model
  std::vector<TimedSamples> timing;  // of each recording, the first kTimedSamples samples in contact
};

// Returns one evaluation per model, in the order of `models` (at least one), which may contain a model twice. `pooled`:
// the evaluation of as many models on earlier recordings, to which this one is added. Errors: interrupted.
Result<Evaluation> evaluate(const Recording& recording, const std::vector<EvaluatedModel>& models,
                            const EvaluationRequest& request = {}, Evaluation pooled = {});

// The motion of a tool at one moment, and how long it stood still before the movement that it belongs to.
struct Motion {
  double position_m = 0.0, velocity_m_per_s = 0.0, hold_s = 0.0;
};
// The motion at point `at` of `count` points. `time_and_position(i)`: s and m, in the order of time. The velocity is a
// difference over 20 ms, so that the steps of an encoder do not matter.
Motion motion_at(std::size_t at, std::size_t count,
                 const std::function<std::pair<double, double>(std::size_t)>& time_and_position);
// "fast release, 4 mm, after a hold of 2 s"; the hold is left out below half a second.
std::string motion_words(const Motion& motion);

}  // namespace palpate
