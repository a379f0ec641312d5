// What the report measures, before anybody draws it.
//
// Thread guarantee: value types.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/evaluation.h"
#include "models/fit/fit.h"
#include "scenes/scene/model_timing.h"
#include "scenes/report/table.h"

namespace palpate {

// One model of the report. "Main" models are one a method, and one more
// of the methods that try candidates, with the paper's other choice of them.
struct PlannedModel {
  std::string name;  // "greedy-100", "greedy-100-of-20" (20 candidates a step)
  MethodRequest request;
  bool main = false;
};

struct RecordingFacts {
  std::string role;  // train, test, both (k-fold)
  std::string name;
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  double seconds = 0.0;
  double rate_Hz = 0.0;
  double deepest_m = 0.0;
  double largest_force_N = 0.0;
};

// Numerical health of one fit of one fold.
struct FitHealth {
  int fold = 0;
  FitReport report;
  std::uint64_t training_samples = 0;
  std::uint64_t sites = 0;
  double training_within_jnd = 0.0;
};

// Errors of the samples whose measured force lies in one bin, of a width that suits
// the data. Source: figures 4 to 7 of Hoever & Harders (2009).
struct ErrorBin {
  double force_from_N = 0.0;
  double force_to_N = 0.0;
  std::uint64_t count = 0;
  double mean_abs_error_N = 0.0;
  double std_abs_error_N = 0.0;  // population standard deviation
  double max_abs_error_N = 0.0;
};

// A model over all folds.
struct ModelResult {
  PlannedModel plan;
  int size = 0;  // centres, or nodes of the grid
  ErrorSummary pooled;
  std::vector<ErrorSummary> per_recording;  // as ReportData::test_names
  // The same with the surface of every test recording moved to the models'.
  ErrorSummary pooled_moved;
  std::vector<ErrorSummary> per_recording_moved;
  std::vector<ErrorBin> bins;  // main models
  std::vector<FitHealth> health;
  double fit_seconds = 0.0;  // mean over the folds, preparation left out
  ModelTiming time;          // of the last fold's model
};

struct SeedResult {
  PlannedModel model;
  std::uint64_t seed = 0;
  ErrorSummary errors;
};

// A moment of a test recording, with what every main model said.
struct TraceRow {
  double time_s = 0.0;
  double measured_N = 0.0;
  std::vector<float> force_N;
  bool in_contact = false;
};

struct WorstTrace {
  std::string recording;
  std::vector<TraceRow> rows;
};

// A point of the feature space, SI.
struct CoveragePoint {
  std::array<double, kMaxFeatures> features{};
  double force_N = 0.0;
};

// Errors of one main model where the test stayed near the training data and where
// it left them.
struct CoverageErrors {
  std::string model;
  ErrorSummary inside;
  ErrorSummary outside;
};

struct Coverage {
  std::vector<FeatureSpec> features;
  std::vector<CoveragePoint> sites;   // what the reduction kept
  std::vector<CoveragePoint> test_inside;
  std::vector<CoveragePoint> test_outside;
  std::vector<CoverageErrors> errors;
};

// Fit time against the number of sites (the paper's figure 8).
struct SitesTime {
  std::string method;
  std::uint64_t sites = 0;
  double seconds = 0.0;
};

// Cost against the dimension (the paper's figure 2).
struct DimensionTime {
  int dimension = 0;
  std::uint64_t nodes = 0;
  double direct_seconds = 0.0;
  double grid_seconds = 0.0;
  double greedy_seconds = 0.0;
};

struct ReportData {
  std::string scene;
  JndLine jnd;
  bool quick = false;
  bool virtual_recordings = false;
  int folds = 0;  // 0: trained and tested on different recordings
  std::vector<RecordingFacts> recordings;
  std::vector<std::string> test_names;
  // What to subtract from the positions of each to move its surface.
  std::vector<double> surface_offset_m;
  std::vector<std::string> relaxation_times;
  std::vector<ModelResult> models;
  std::vector<SeedResult> seeds;
  WorstTrace trace;
  Coverage coverage;
  std::vector<SitesTime> sites_time;
  std::vector<DimensionTime> dimension_time;
  std::uint64_t dimension_sites = 0;
  // The stability suite's hard cases, when there are any.
  std::optional<Table> hard_cases;
};

// How many main models there are; they come first in data.models.
inline std::size_t main_models(const ReportData& data) {
  std::size_t count = 0;
  for (const ModelResult& model : data.models) count += model.plan.main ? 1 : 0;
  return count;
}

}  // namespace palpate
