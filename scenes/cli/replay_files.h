// Input and output of `palpate replay`: models with unique names, FORCES.csv, a figure.
// Thread guarantee: slow side (does I/O, starts gnuplot); one thread per object.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/result.h"
#include "engine/tick/replay.h"
#include "models/model/fitted_model.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate::cli {

struct LoadedModel {
  std::string name;  // unique among the models of one run
  std::shared_ptr<const FittedModel> model;
};

// `names`: one for each file. Empty: the names in the files, or the file names where those are equal. Equal names get
// the suffixes -2, -3 ... Errors: more than kMaxModels models; another number of names; a file that is no model.
Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& names = {});

// FORCES.csv with one row per sample: time_s, position_m, force_N, depth_m, each distinct feature of the models (equal
// names get the suffixes -2, -3 ...), then "<model name>_N" for each model.
class ForcesFile {
 public:
  // Errors: as AtomicFile::create.
  static Result<ForcesFile> create(const std::string& path, bool overwrite, const std::vector<LoadedModel>& models);

  void add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick);
  Status commit() { return file_.commit(); }

 private:
  struct FeatureColumn {
    std::size_t model;  // the first with this feature
    std::size_t index;  // in that model's feature vector
  };

  explicit ForcesFile(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
  std::vector<FeatureColumn> columns_;
};

// `names` with suffixes -2, -3 ... for repeated names.
std::vector<std::string> distinct_names(const std::vector<std::string>& names);

// A figure of a replayed recording: the measured force, every model's difference from it over the JND, and the error
// against the force.
class ReplayPlot {
 public:
  explicit ReplayPlot(const std::vector<LoadedModel>& models) : models_(models) {}

  // Call it for every row in time order. A row takes about 50 bytes, and 4 for each model.
  void add(const RecordingRow& row, const TickSnapshot& snapshot);
  // `errors`: of the same rows, one per model. Errors: those of draw_plot (scenes/plot/draw.h).
  Status draw(const std::string& path, const std::string& recording, const std::vector<ErrorSummary>& errors,
              bool overwrite) const;

 private:
  struct Moment {
    double time_s, measured_N;
    bool in_contact;
    std::vector<float> over_jnd;  // difference of each model from the measured force
  };

  const std::vector<LoadedModel>& models_;
  std::vector<Moment> moments_;
};

}  // namespace palpate::cli
