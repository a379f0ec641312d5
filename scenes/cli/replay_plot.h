// A replayed recording as a figure: the measured force, every model's difference from
// it over the JND, and the error against the force.
// Thread guarantee: slow side; one thread per object; `draw` starts gnuplot.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/replay.h"
#include "scenes/cli/replay_files.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate::cli {

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
