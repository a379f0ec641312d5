// Evaluates models on recordings through the tick of the live loop, kMaxModels at a time, and measures their time.
// Errors are computed with the positions as recorded; with a surface offset subtracted from every position of a
// recording, which is estimated for each model, or once for all; and, where a recording begins under a preload, with
// the offset of a training recording that does so elsewhere. With an offset, contact is determined anew.
//
// Computation time, measured on samples in contact:
//   tick         motion estimate, features and force of this one model
//   evaluation   the force alone, from features that are computed before
// There are kTimingRounds rounds, and each round times every model once, so that a slow phase of the machine
// affects all models. The true median lies between the least and the greatest of n rounds with probability
// 1 - 2^(1 - n): 97 % for six.
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/haptics_tick.h"
#include "models/samples/samples.h"
#include "models/samples/selection.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate {

using ModelPointer = std::shared_ptr<const ForceModel>;

inline constexpr int kTimingRounds = 6;

// A round takes the mean time of a step in each block of 64 steps, and of these means median and 99th percentile.
struct Timing {
  double median_ns = 0.0;  // median of the rounds' medians
  double low_ns = 0.0;     // the least of these medians
  double high_ns = 0.0;    // the greatest of these medians
  double p99_ns = 0.0;     // median of the rounds' 99th percentiles
};

struct ModelTiming {
  Timing tick;
  Timing evaluation;
  bool measured = false;  // false: there were no samples
};

// Largest number of samples of one recording that are timed. All are in contact; in air no model is evaluated.
inline constexpr std::size_t kTimedSamples = 4096;

// Samples of one recording, with its sensor.
struct TimedSamples {
  SensorSpec sensor;
  std::vector<ToolSample> samples;
};

// Returns one result per model, over these samples; without any stretch, over its own ProbingStrokes. Each evaluation
// depends on the last force, so that the processor cannot overlap them.
std::vector<ModelTiming> time_models(const std::vector<ModelPointer>& models,
                                     const std::vector<TimedSamples>& stretches);

// Estimates the surface of a test recording for given models: the shift of the positions, over all overlaps of
// recording and model, that minimises the error of the models' forces (selection.h). Errors are in JND with a
// Huber loss beyond 1; outside the surface a model's force is 0, as in the tick. A shift counts as 0 within two
// standard errors of 0, and is not identified if a force offset explains the data as well.
// `rows`: a whole recording in time order, thinned. The costs of several models are added. `at`: to be subtracted from
// position_m so that 0 is the models' surface, m. Without models or rows it is not identified.
OffsetEstimate locate_surface(const std::vector<Sample>& rows, const std::vector<ModelPointer>& models,
                              const JndLine& jnd);

struct EvaluatedModel {
  ModelPointer model;
  JndLine jnd;
};

// Whether two recordings begin under one preload: beyond 0.2 N, and their first forces differ by less than 3 JND.
bool same_preload(double first_N, double other_first_N, const JndLine& jnd);
// What is to be subtracted from the positions of a recording that begins at rest under a preload, so that it begins
// where the training recording with the nearest first force begins; 0 if there is no preload, no such recording, or a
// distance below 2 % of the range. It uses a force of the test, so that it is no figure as recorded.
double preload_offset_m(const Recording& recording, const EvaluatedModel& model);

struct EvaluationRequest {
  // Called for every row, with positions as recorded and the first kMaxModels different models; may be empty.
  ReplayVisitor also{};
  // Errors count from this time of the recording on. Earlier rows are replayed because the features have memory.
  double counted_from_s = -std::numeric_limits<double>::infinity();
  const Recording* after = nullptr;  // the recording that this one continues (engine/tick/haptics_tick.h)
  double force_zero_N = 0.0;         // subtracted from every measured force, also for `also`: that of free air
  bool move_surface = true;          // false: the figures with the surface moved equal those as recorded
  bool move_beginning = false;       // true: also those with `beginning_m`, where it is not 0
  // The models from which one common surface offset is estimated. Empty: each model has its own estimate.
  std::vector<ModelPointer> surface_models{};
  FitControl control{};
};

// Of one model over all recordings.
struct ModelEvaluation {
  ModelErrors as_recorded, surface_moved, beginning_moved;
  std::vector<OffsetEstimate> surfaces;  // of each recording; its offset is 0 if not identified
  int began = kBeganAtRest;              // the last recording (HapticsTick::began)
  double beginning_m = 0.0;              // the last offset of preload_offset_m
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

// The recording with this force subtracted from every row.
Recording with_force_zero(Recording recording, double force_zero_N);

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
