// The measurements of the report (fits, errors and times), and the choice of a model by them.
// Thread guarantee: slow side; the fits start threads.
#pragma once

#include <optional>

#include "engine/base/fit_control.h"
#include "models/check/noise_floor.h"
#include "models/fit/model_fits.h"
#include "models/model/fitted_model.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/report/plan.h"
#include "scenes/report/recordings.h"
#include "scenes/scene/scene.h"

namespace palpate {

inline constexpr double kStretchSeconds = 5.0;

struct StretchRow {
  double time_s = 0.0;
  double measured_N = 0.0;
  bool in_contact = false;
  std::vector<double> force_N;  // one per model
};

struct WorstStretch {
  std::string recording;
  double score = -1.0;  // mean of (error / JND)^2 of the first model; below 0: none was found
  std::vector<StretchRow> rows;
  std::vector<std::size_t> models;  // indices of ReportData::models; set by `measure`
};

// The stretch of kStretchSeconds in which the first of `models` has the largest mean of (error / JND)^2 over the
// samples in contact; a shorter recording is one stretch. The divisor of the mean is at least a quarter of all samples
// of the stretch. `models`: up to kMaxModels. Samples before `from_s` are replayed, but do not count.
WorstStretch worst_stretch(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd,
                           double from_s = -1e300);

// The results of a planned model over all folds. The errors of all models are over the same samples.
struct ModelResult {
  std::string name = "no force";
  std::optional<ModelPlan> plan;             // none: 0 N
  int size = 0;                              // centres, or nodes of the grid; the largest of all folds
  UnitErrors errors;                         // positions as recorded
  ErrorSummary moved;                        // with the surface offset of every test recording subtracted
  double fit_seconds = 0.0;                  // mean over the folds, without the preparation
  ModelTiming time;                          // of the last fold's model, on all test recordings
  std::shared_ptr<const FittedModel> model;  // of the last fold; null: no force
  std::vector<ModelPointer> fits;            // of each fold; empty: no force
  // The errors of every sample during `measure`, which computes `errors` and `moved` from them; empty in its result.
  ModelErrors recorded_samples{JndLine{}};
  ModelErrors moved_samples{JndLine{}};
  std::vector<std::string> same;  // names of further planned models with the same forces
};

// A test recording with its estimated surface offset; 0: none.
struct MovedSurface {
  std::string name;
  double offset_m = 0.0;
};

// The choice of a model. All numbers are indices of ReportData::models.
struct Choice {
  std::vector<std::size_t> candidates;  // one per family
  std::vector<std::size_t> qualified;   // non-inferior candidates
  std::size_t best = 0;                 // the candidate with the smallest 99 % error
  std::size_t recommended = 0;
  // The most accurate model of another size that dominates the recommended one. It is no candidate, because that would
  // choose its size by the test.
  std::optional<std::size_t> dominating;
  bool correction_off = false;  // the correction is 0, so that all of this program's methods equal the trend
};

struct ReportData {
  Scene scene;
  RecordingSet recordings;
  std::vector<MovedSurface> tested;  // every test recording
  NoiseFloor floor;                  // of all test recordings together
  std::vector<ModelResult> models;   // the first is always 0 N; no two have the same forces
  Choice choice;
  WorstStretch worst;                     // of the recommended model
  std::vector<RecordingOffset> surfaces;  // of the training recordings; this and the following: of the first fold
  std::vector<double> papers_times_s;     // relaxation times identified for the methods on the measured force
  std::optional<bool> corrects;           // whether cross-validation selected the correction
  std::vector<PartGain> gains;            // of each part of the trend
};

// Fits every planned model once per fold and pools its errors over the folds. All results but times are
// deterministic. Errors: those of the recordings and the fits, with the recordings' names; interrupted.
Result<ReportData> measure(const RecordingSet& recordings, const Scene& scene, bool quick, const FitControl& control);

// The candidates are the main models of the plan; rank() recommends one of them by the test errors and times.
Choice choose(const std::vector<ModelResult>& models);
// The models of the page's first table: no force and the candidates.
std::vector<std::size_t> headline_models(const ReportData& data);

}  // namespace palpate
