// What palpate replay reads and writes: models under names that tell them apart, FORCES.csv, a figure.
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
  std::string name;  // distinct among the models of one run
  std::shared_ptr<const FittedModel> model;
};

// `names`: one for each file, or none; models that then have one name are named by
// their files. Errors: too many models; a file that is no model, or a recording.
Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& names = {});

// FORCES.csv, one row per sample: time_s, position_m, force_N, depth_m, each distinct feature of the models
// once (those that share a name get the suffix -2, -3 ...), then "<model name>_N" per model.
class ForcesFile {
 public:
  // Errors: as AtomicFile::create.
  static Result<ForcesFile> create(const std::string& path, bool overwrite, const std::vector<LoadedModel>& models);

  void add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick);
  Status commit() { return file_.commit(); }

 private:
  struct FeatureColumn {
    std::size_t model;  // the first that has it
    std::size_t index;  // in that model's feature vector
  };

  explicit ForcesFile(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
  std::vector<FeatureColumn> columns_;
};

// `names` with -2, -3 ... behind those that came before, so that all differ.
std::vector<std::string> distinct_names(const std::vector<std::string>& names);

// A replayed recording as a figure: the measured force, every model's difference from
// it over the JND, and the error against the force.
class ReplayPlot {
 public:
  explicit ReplayPlot(const std::vector<LoadedModel>& models) : models_(models) {}

  // Every row in time order; keeps 8 bytes a model and 32 more.
  void add(const RecordingRow& row, const TickSnapshot& snapshot);
  // `errors`: of the same rows, one a model. Errors: those of draw_plot (scenes/plot/draw.h).
  Status draw(const std::string& path, const std::string& recording, const std::vector<ErrorSummary>& errors,
              bool overwrite) const;

 private:
  struct Moment {
    double time_s;
    double measured_N;
    bool in_contact;
    std::vector<float> over_jnd;  // a model: its difference from the measured force
  };

  const std::vector<LoadedModel>& models_;
  std::vector<Moment> moments_;
};

}  // namespace palpate::cli
