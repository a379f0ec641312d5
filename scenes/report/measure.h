// Every measurement of the report: fits, errors and times. What follows from them is choice.h's.
// Thread guarantee: slow side; the fits start threads themselves.
#pragma once

#include "engine/base/fit_control.h"
#include "models/fit/fit.h"
#include "models/model/fitted_model.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/evaluation/noise_floor.h"
#include "scenes/report/plan.h"
#include "scenes/report/recordings.h"
#include "scenes/scene/scene.h"

namespace palpate {

inline constexpr double kStretchSeconds = 5.0;

struct StretchRow {
  double time_s = 0.0;
  double measured_N = 0.0;
  bool in_contact = false;
  std::vector<double> force_N;  // of the models, in their order
};

struct WorstStretch {
  std::string recording;
  double score = -1.0;  // mean squared error over the JND of the first model
  std::vector<StretchRow> rows;
  std::vector<std::size_t> models;  // of the report
};

// The kStretchSeconds with the largest mean squared error/JND of the first of `models` over
// the samples in contact; the whole of a shorter recording. Up to kMaxModels models.
// What came before `from_s` is replayed, but does not count.
WorstStretch worst_stretch(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd,
                           double from_s = -1e300);

// A model over all folds; errors over the same samples as every other's.
struct ModelResult {
  PlannedModel plan;
  int size = 0;                              // centres, or nodes of the grid
  Evidence errors;                           // positions as recorded
  ErrorSummary moved;                        // the surface of every test recording moved to the models'
  double fit_seconds = 0.0;                  // mean over the folds, preparation left out
  ModelTiming time;                          // of the last fold's model, on all test recordings
  std::shared_ptr<const FittedModel> model;  // likewise; null: no force
  std::vector<std::string> same;             // further models of the plan that give the same forces
};

// A test recording whose surface the models find elsewhere.
struct MovedSurface {
  std::string name;
  double offset_m = 0.0;
};

// Which model to use (choose.cpp).
struct Choice {
  std::vector<std::size_t> candidates;  // one a method and recipe, indices of models
  std::vector<std::size_t> qualified;   // of the candidates
  std::size_t best = 0;                 // the smallest 99 % error of the candidates
  std::size_t recommended = 0;
  bool correction_off = false;  // all of this program's methods give the forces of the trend
};

struct ReportData {
  std::string scene;
  JndLine jnd;
  bool quick = false;
  bool virtual_recordings = false;
  int folds = 0;          // of a cross-validation; 0: test recordings
  std::string tested_on;  // in words where there are no test recordings
  std::vector<RecordingFacts> recordings;
  std::vector<MovedSurface> tested;  // every test recording
  NoiseFloor floor;                  // of all test recordings together
  std::vector<ModelResult> models;   // the first always says 0 N; no two give the same forces
  Choice choice;
  WorstStretch worst;                         // of the recommended model
  std::vector<RecordingSurface> surfaces;     // of the training recordings
  std::vector<double> times_2009_s;           // relaxation times fitted for the 2009 recipe
  std::optional<double> correction_strength;  // 0 to 1
  std::vector<PartGain> gains;
};

// Errors: those of the recordings and the fits, with the recordings' names; interrupted.
// The same recordings and plan give the same figures but for times. With several folds
// every model is fitted once a fold and its errors are taken together.
Result<ReportData> measure(const RecordingSet& recordings, const Scene& scene, bool quick, const FitControl& control);

// One size of every method and recipe, by the cross-validated error of the training, and of these the
// one that rank() takes on the test.
Choice choose(const std::vector<ModelResult>& models);
// What the first screen shows: no force and the candidates, of the recipe of 2009 only the method that the paper
// recommends.
std::vector<std::size_t> headline_models(const ReportData& data);

}  // namespace palpate
