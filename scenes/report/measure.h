// The measurements of the report (fits, errors and times), and the choice of a model by them.
// Thread guarantee: slow side; the fits start threads.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/check/check_recording.h"
#include "models/fit/fit.h"
#include "models/model/fitted_model.h"
#include "models/samples/samples.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/plot/plot.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The recordings of the paper on a virtual material: 41.499 s with seed 1 for training, 45.272 s with seed 2 for the
// test. `share`: of both durations. Errors: those of record_sensors.
Result<std::vector<PreparedRecordingPointer>> virtual_recordings(const std::string& material, double share = 1.0);

// Combines the progress of parts of different lengths, which are given in one unit.
class Progress {
 public:
  Progress(FitControl whole, double total) : whole_(std::move(whole)), total_(total) {}

  // The control of the next part.
  FitControl next(double length) {
    const double begin = std::min(1.0, done_ / total_);
    done_ += length;
    return whole_.part(begin, std::min(1.0, done_ / total_));
  }

 private:
  FitControl whole_;
  double total_;
  double done_ = 0.0;
};

inline double largest_force_N(const Recording& recording) {
  return std::ranges::max_element(recording.rows, {}, &RecordingRow::force_N)->force_N;
}

// Training and test data of one fold.
struct Split {
  std::vector<PreparedRecordingPointer> train;
  std::vector<PreparedRecordingPointer> tested;
  double counted_from_s = -1e300;  // earlier samples are replayed because the features have memory, but do not count
  std::string words;               // describes test data that are a part of the training recordings; else empty
};

struct RecordingSet {
  std::vector<Split> folds;                   // one, or several for a cross-validation
  std::vector<PreparedRecordingPointer> all;  // the training recordings come first
  std::size_t trained = 0;                    // number of training recordings; all.size(): each is also a test

  bool is_tested(std::size_t i) const { return i >= trained || trained == all.size(); }
};

// Equal forces in this number of successive rows, kLeakValues (measure.cpp) different ones or more, are a leak.
inline constexpr std::size_t kLeakRows = 50;

struct SharedStretch {
  std::size_t first_row = 0;    // in `tested`
  std::size_t trained_row = 0;  // in `trained`
  std::size_t rows = 0;         // 0: there is none
};

// The first stretch of `tested` that is found with the forces of a stretch of `trained`, compared bit by bit, because
// sensor noise makes them unique to a recording. A common stretch of at least
// 2 kLeakRows rows is always found if each kLeakRows successive rows of it have that many different forces.
SharedStretch shared_stretch(const Recording& trained, const Recording& tested);

// Without a training recording, virtual silicone is used: seed 1 for training, seed 2 for the test. Without a test
// recording, the training recordings are divided into up to kMostFolds folds for cross-validation; a single recording
// is divided into training data and a block at its end as the test. Recordings are sorted by name and content.
// Errors: a test recording shares a stretch with a training recording; a test recording without contact; a single
// recording that is too short.
inline constexpr std::size_t kMostFolds = 5;
Result<RecordingSet> split_recordings(std::vector<PreparedRecordingPointer> train,
                                      std::vector<PreparedRecordingPointer> test);

// The forces of models over one test recording.
struct TestCurves {
  const Recording* recording = nullptr;
  std::vector<ComparedMoment> moments;  // the rows that count
  // The stretch of 5 s in which the first model has the largest mean of (error / JND)^2 over the samples in
  // contact, without the free air at its ends; a shorter recording is one stretch. The divisor of the mean is at least
  // a quarter of all samples of the stretch. It contains both rows, indices of `moments`.
  std::size_t first = 0, last = 0;
  double score = -1.0;                // that mean; below 0: there is no recording
  std::vector<std::size_t> models{};  // indices of ReportData::models, the recommended first; set by `measure`
};

// Curves over the force omit bins with fewer samples.
inline constexpr std::uint64_t kFewSamples = 20;

// Whether the model is one of the comparison that everybody sees: voxel, random, kdtree and greedy as in the paper, the
// trend, and the trend corrected by greedy.
bool is_main(const ModelPlan& plan);

// Methods that draw random numbers (methods.h, kTakesSeed) are fitted with this number of seeds.
inline constexpr std::uint64_t kSeeds = 5;
// A method that selects centres is fitted with the number in its plan, 100, and with that of these numbers that
// cross-validation of the training recordings selects: the one with the lowest error of random centres.
inline constexpr int kSizes[] = {10, 20, 50, 100, 200};
using ErrorBySize = std::vector<std::pair<int, double>>;  // number of centres, cross-validated error over the JND

// The results of a planned model over all folds. The errors of all models are over the same samples. Of a method that
// draws random numbers each figure is the median over the seeds.
struct ModelResult {
  std::string name = "no force";
  std::optional<ModelPlan> plan;     // none: 0 N
  bool selects_size = false;         // its number of centres is selected in each fold
  int size = 0;                      // centres, or nodes of the grid; the largest of all folds
  int least_size = 0;                // the smallest of all folds
  Eigen::Index rank = 0;             // of its equations, of centres and tail, in the last fold; 0: without equations
  UnitErrors errors;                 // positions as recorded
  ErrorSummary moved;                // with the surface offset of every test recording subtracted
  ErrorSummary untared;              // with the forces as recorded; empty where no force zero is subtracted
  std::uint64_t seeds = 1;           // number of fits with different seeds
  Interval within_range, p99_range;  // least and greatest of them
  double fit_seconds = 0.0;          // mean over the folds, without the preparation
  ModelTiming time;                  // of the last fold's model, on all test recordings
  std::shared_ptr<const FittedModel> model;  // of the last fold; null: no force
  std::vector<ModelPointer> fits;            // of each fold; empty: no force
  std::size_t place = 0;                     // in the evaluation
  std::vector<std::string> same;             // names of further planned models with the same forces

  Candidate candidate() const {
    return {errors.within_jnd, errors.p99_error_over_jnd, time.tick.median_ns, &errors.drawn_strokes};
  }
};

// A test recording, and the estimate of its surface for the trend models.
struct TestedRecording {
  PreparedRecordingPointer recording;
  OffsetEstimate surface;
};

struct ReportData {
  Scene scene{};
  double budget_ns = kBudget_ns;  // the longest tick of a candidate
  RecordingSet recordings{};
  const Recording* after = nullptr;  // the recording that the tests continue
  std::vector<TestedRecording> tested{};
  // Rows of each recording in contact, as its errors count.
  std::map<const PreparedRecording*, std::ptrdiff_t> contact{};
  NoiseFloor floor{};                       // of all test recordings together
  std::vector<ModelResult> models{};        // the first is always 0 N; no two have the same forces
  Ranking choice{};                         // of `models`
  TestCurves curves{};                      // of the recording with the worst stretch of the recommended model
  std::vector<RecordingOffset> surfaces{};  // of the training recordings; this and the following: of the first fold
  std::vector<double> papers_times_s{};     // relaxation times identified for the methods on the measured force
  bool corrects = true;                     // whether cross-validation selected the correction
  std::vector<PartGain> gains{};            // of each part of the trend
  std::map<int, OpenChoices> choices{};   // of the methods on the measured force, by their number of centres; 0: direct
  std::map<Base, ErrorBySize> by_size{};  // empty in a quick report
};

// Fits every planned model once per fold and pools its errors over the folds. The forces of a test recording count from
// those of its own free air, as those of a training recording do. `quick`: the main models with 100 centres. `after`:
// the recording that the tests continue, or null. All results but times are deterministic. Errors: those of the
// recordings and the fits, with the recordings' names; interrupted.
Result<ReportData> measure(const RecordingSet& recordings, const Scene& scene, bool quick, double budget_ns,
                           const FitControl& control, const Recording* after = nullptr);

// Every model but no force is a candidate.
Ranking choose(const std::vector<ModelResult>& models, double budget_ns = kBudget_ns);
// The models of the page's first table: no force, the main models, the best and the recommended one.
std::vector<std::size_t> headline_models(const ReportData& data);

}  // namespace palpate
