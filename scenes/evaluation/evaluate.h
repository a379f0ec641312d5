// Evaluates models on one recording through the tick of the live loop, kMaxModels at a time. Errors are computed twice:
// with the positions as recorded, and with a surface offset subtracted from every position. The offset is estimated for
// each model (scenes/evaluation/surface_search.h), or once for all models. With the offset, contact is determined anew.
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
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

// A recording that can be replayed several times. A call steps a tick with up to kMaxModels models through all rows;
// `surface_offset_m` is subtracted from every position before.
using RowSource = std::function<Result<ReplaySummary>(const ForceModels& models, const ReplayVisitor& visitor,
                                                      double surface_offset_m)>;
RowSource rows_of(const Recording& recording);    // `recording` outlives the result
RowSource rows_of_file(const std::string& path);  // reads the file in each replay, in bounded memory

struct EvaluationRequest {
  // Called for every row, with positions as recorded and the first kMaxModels models; may be empty.
  ReplayVisitor also;
  // Errors count from this time of the recording on. Earlier rows are replayed because the features have memory.
  double counted_from_s = -std::numeric_limits<double>::infinity();
  bool move_surface = true;  // false: the figures with the surface moved equal those as recorded
  // The models from which one common surface offset is estimated. Empty: each model has its own estimate.
  std::vector<ModelPointer> surface_models;
  FitControl control;
};

// A model's predicted 95 % error bounds. All figures are NaN for a model without bounds.
struct BoundFigures {
  double coverage = kUnknown;         // share of the errors within the bound
  double median_N = kUnknown;         // of the bounds
  double median_over_jnd = kUnknown;  // of bound / JND; NaN where `median_N` exceeds the largest force: it says nothing

  bool has_bounds() const { return std::isfinite(coverage); }
};

// Collects the bounds of one model at the samples in contact. It stores 8 bytes per sample.
class BoundErrors {
 public:
  // `bound_N`: NaN for a model without bounds.
  void add(double bound_N, double model_N, double measured_N, const JndLine& jnd);
  // Adds the samples of another recording.
  void append(const BoundErrors& other);
  BoundFigures figures() const;

 private:
  std::vector<float> bound_N_, over_jnd_;
  std::size_t covered_ = 0;
  double largest_force_N_ = 0.0;
};

struct ModelEvaluation {
  ModelErrors as_recorded;
  ModelErrors surface_moved;
  BoundErrors bound_as_recorded;
  BoundErrors bound_surface_moved;
  OffsetEstimate surface;  // its offset is 0 if not identified
};

struct RecordingEvaluation {
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  std::vector<ModelEvaluation> models;
  ModelErrors no_force{JndLine{}};  // of a model that is always 0 N, as recorded, with the JND of the first model
  TimedSamples timing;              // the first kTimedSamples samples in contact, for time_models
};

// Returns one evaluation per model, in the order of `models` (at least one). Errors: those of `rows`; interrupted.
Result<RecordingEvaluation> evaluate(const RowSource& rows, const std::vector<EvaluatedModel>& models,
                                     const EvaluationRequest& request = {});

}  // namespace palpate
