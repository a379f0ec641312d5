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
#include "scenes/plot/compared_forces.h"

namespace palpate::cli {

struct LoadedModel {
  std::string name;  // unique among the models of one run
  std::shared_ptr<const FittedModel> model;
};

// `names`: one for each file. Empty: the names in the files, or the file names where those are equal. Equal names get
// the suffixes -2, -3 ... Errors: more than kMaxModels models; another number of names; a file that is no model.
Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& names = {});

// FORCES.csv with one row per sample: time_s, position_m, force_N, depth_m, each distinct feature of the models, then
// "<model name>_N" for each model.
class ForcesFile {
 public:
  // Errors: as AtomicFile::create.
  static Result<ForcesFile> create(const std::string& path, bool overwrite, const std::vector<LoadedModel>& models);

  void add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick);
  Status commit() { return file_.commit(); }

 private:
  explicit ForcesFile(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
  // The first model with each feature, and the place in its feature vector.
  std::vector<std::pair<std::size_t, std::size_t>> columns_;
};

// `names` with suffixes -2, -3 ... for repeated names.
std::vector<std::string> distinct_names(const std::vector<std::string>& names);

// Draws the measured force, every model's difference from it over the JND, and the error against the force.
// `errors`: one per model. Errors: those of draw_plot (scenes/plot/draw.h).
Status draw_replay(const std::string& path, const std::string& recording, const std::vector<LoadedModel>& models,
                   const std::vector<ComparedMoment>& moments, const std::vector<ErrorSummary>& errors, bool overwrite);

}  // namespace palpate::cli
