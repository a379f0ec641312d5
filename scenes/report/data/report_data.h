// What the report measures, before anybody draws it.
//
// Thread guarantee: value types.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/evaluation.h"
#include "models/fit/fit.h"
#include "models/model/fitted_model.h"
#include "scenes/report/data/noise_floor.h"
#include "scenes/report/data/stroke_errors.h"
#include "scenes/report/data/table.h"
#include "scenes/scene/model_timing.h"

namespace palpate {

// The ladder that every comparison stands on, from the lowest rung:
//   no_force  a model that always says 0 N
//   trend     the viscoelastic trend alone, no radial basis function
//   paper     the recipe of Hoever & Harders (2009): 50 mN reduction, rows scaled
//             by 1/f, low-pass features
//   palpate   this program's defaults
enum class Rung { no_force, trend, paper, palpate };
inline constexpr std::array<const char*, 4> kRungNames{"no force", "trend", "the paper's recipe", "Palpate"};
// In commands, tables and names of models.
inline constexpr std::array<const char*, 4> kRungKeys{"none", "trend", "paper", "palpate"};
inline const char* rung_name(Rung rung) { return kRungNames[static_cast<std::size_t>(rung)]; }
inline const char* rung_key(Rung rung) { return kRungKeys[static_cast<std::size_t>(rung)]; }

// One model of the report. "Main" models are one a rung and method.
struct PlannedModel {
  std::string name;  // "greedy-100", "paper-greedy-100", "greedy-100-of-20" (20 candidates a step)
  Rung rung = Rung::palpate;
  MethodRequest request;
  bool main = false;

  // Greedy with fewer candidates a step than usual.
  bool few_candidates() const {
    return request.method->can_take(kTakesCandidates) && request.candidates > 0 &&
           request.candidates < MethodRequest{}.candidates;
  }
};

struct RecordingFacts {
  std::string role;  // train, test, both (k-fold)
  std::string name;
  std::string content_hash;  // of positions and forces, hexadecimal
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  double seconds = 0.0;
  double rate_Hz = 0.0;
  double deepest_m = 0.0;
  double largest_force_N = 0.0;
  NoiseFloor noise;
};

// Numerical health of one fit of one fold.
struct FitHealth {
  int fold = 0;
  FitReport report;
  std::uint64_t training_samples = 0;
  std::uint64_t sites = 0;
  double training_within_jnd = 0.0;
};

// Errors of the samples whose measured force lies in one bin. Source: figures 4 to 7
// of Hoever & Harders (2009); error over JND and over force are taken sample by sample.
struct ErrorBin {
  double force_from_N = 0.0;
  double force_to_N = 0.0;
  std::uint64_t count = 0;
  double mean_force_N = 0.0;
  double mean_abs_error_N = 0.0;
  double std_abs_error_N = 0.0;  // population standard deviation
  double max_abs_error_N = 0.0;
  double mean_error_over_jnd = 0.0;
  double std_error_over_jnd = 0.0;
  double max_error_over_jnd = 0.0;
};

// A model over all folds; errors as recorded and with the surface of every test
// recording moved to the models'.
struct ModelResult {
  PlannedModel plan;
  int size = 0;  // centres, or nodes of the grid
  Evidence pooled;
  Evidence pooled_moved;
  std::vector<Evidence> per_recording;  // as ReportData::test_names
  std::vector<Evidence> per_recording_moved;
  Evidence left_out;  // on training strokes left out; no samples: not fitted to the others
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
  double position_m = 0.0;
  double measured_N = 0.0;
  std::vector<float> force_N;
  std::uint32_t out_of_domain = 0;  // bit i: main model i
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
  std::string reference;  // the model whose data count
  std::vector<FeatureSpec> features;
  std::vector<CoveragePoint> sites;   // what the reduction kept
  std::vector<CoveragePoint> test_inside;
  std::vector<CoveragePoint> test_outside;
  std::vector<CoverageErrors> errors;
};

// Fit time against the number of sites (the paper's figure 8).
struct SitesTime {
  std::string model;  // its name
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

// Which model to take, chosen on training strokes that were left out of the fit and
// only then tested (recommendation.h).
struct Recommendation {
  std::string chosen;               // on the left-out strokes
  std::string recommended;          // empty: none
  std::vector<std::string> tied;    // with the best on the left-out strokes
  bool left_out = false;            // false: there was nothing to leave out
  std::string reason;               // sentences
};

// The stuff that a model is made of, for the recommended one; SI (model_facts.h).
struct ModelFacts {
  std::string model;
  std::vector<std::vector<TableCell>> values;     // quantity, value, unit, meaning
  std::vector<std::vector<TableCell>> features;   // name, lowest, highest
  std::vector<std::array<double, 6>> depth;  // depth_m, elastic_N, stiffness, viscosity at rest, at v_0, instantaneous
  std::vector<std::array<double, 2>> spectrum;  // relaxation time, stiffness
};

struct ReportData {
  std::string scene;
  JndLine jnd;
  bool quick = false;
  bool virtual_recordings = false;
  int folds = 0;  // 0: trained and tested on different recordings
  std::vector<RecordingFacts> recordings;
  std::vector<std::string> test_names;
  std::vector<NoiseFloor> floors;          // as test_names
  NoiseFloor pooled_floor;
  // What to subtract from the positions of each to move its surface.
  std::vector<double> surface_offset_m;
  std::vector<std::string> relaxation_times;
  std::vector<FeatureWorth> worth;  // of the features, where the recordings chose them
  std::vector<ModelResult> models;
  std::map<std::string, std::shared_ptr<const FittedModel>> fitted;  // of the last fold, by name
  std::vector<SeedResult> seeds;
  WorstTrace trace;
  Coverage coverage;
  std::vector<SitesTime> sites_time;
  std::vector<DimensionTime> dimension_time;
  std::uint64_t dimension_sites = 0;
  Recommendation recommendation;
  ModelFacts facts;
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
