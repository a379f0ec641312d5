// Models against test recordings: every sample goes through the tick of the live
// loop, sixteen models at a time.
//
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <memory>
#include <vector>

#include "engine/base/fit_control.h"
#include "models/model/fitted_model.h"
#include "scenes/report/recordings.h"
#include "scenes/report/report_data.h"

namespace palpate {

using ModelPointer = std::shared_ptr<const FittedModel>;

// Errors of some models, recording by recording and together. The same models in the
// same order every time, from one fold to the next.
class Jury {
 public:
  Jury(std::size_t models, const JndLine& jnd) : jnd_(jnd), pooled_(models, ErrorStatistics(jnd)) {}

  // One summary per model for this recording, which also counts in `pooled`;
  // `surface_offset_m` as in engine/tick/replay.h. Errors: interrupted.
  Result<std::vector<ErrorSummary>> judge(const Recording& recording, const std::vector<ModelPointer>& models,
                                          const FitControl& control = {}, double surface_offset_m = 0.0);

  std::vector<ErrorSummary> pooled() const;

 private:
  JndLine jnd_;
  std::vector<ErrorStatistics> pooled_;
};

// Errors against the measured force, in bins.
class BinnedErrors {
 public:
  // `largest_force_N`: of all recordings; some dozen bins up to there.
  explicit BinnedErrors(double largest_force_N);
  void add(double model_N, double measured_N);
  std::vector<ErrorBin> bins() const;  // those with samples

 private:
  double width_N_;
  std::vector<ErrorBin> bins_;  // std_abs_error_N holds the sum of squares around the mean
};

// Keeps the worst kTraceSeconds among the recordings it is shown: those with the
// largest mean squared error/JND over the samples in contact and the main models.
class TraceFinder {
 public:
  static constexpr double kTraceSeconds = 5.0;

  explicit TraceFinder(const JndLine& jnd) : jnd_(jnd) {}
  // `models`: the main ones.
  Status look_at(const Recording& recording, const std::vector<ModelPointer>& models);
  const WorstTrace& worst() const { return worst_; }

 private:
  JndLine jnd_;
  WorstTrace worst_;
  double worst_score_ = -1.0;
};

// Where the test recordings went in the feature space of `reference`, and what the
// main models' errors were near the training data and away from them.
class CoverageFinder {
 public:
  CoverageFinder(const JndLine& jnd, std::vector<std::string> model_names, double largest_force_N);
  void add_sites(const TrainingSet& set);
  // `models`: as the names; the last one is the reference for inside and outside.
  Status look_at(const Recording& recording, const std::vector<ModelPointer>& models);
  Coverage result() const;
  std::vector<ErrorBin> bins(std::size_t model) const { return bins_[model].bins(); }

 private:
  std::vector<std::string> names_;
  std::vector<ErrorStatistics> inside_;
  std::vector<ErrorStatistics> outside_;
  std::vector<BinnedErrors> bins_;
  Coverage coverage_;
};

// At most `most` of `points`, evenly spread over their order.
std::vector<CoveragePoint> thinned(const std::vector<CoveragePoint>& points, std::size_t most);

}  // namespace palpate
