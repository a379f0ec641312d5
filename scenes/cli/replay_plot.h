// A replayed recording as a figure: the measured force, every model's difference from
// it over the JND, and the error against the force. Drawn by
// assets/figures/report/replay.gp.
// Thread guarantee: slow side; one thread per object; `draw` starts gnuplot.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/replay.h"
#include "scenes/cli/replayed_recording.h"

namespace palpate::cli {

class ReplayPlot {
 public:
  explicit ReplayPlot(const std::vector<LoadedModel>& models);

  // Every row in time order; keeps 4 bytes a model and 24 more.
  void add(const RecordingRow& row, const TickSnapshot& snapshot);
  // `path` ends in .svg or .png. Errors: it does not; it exists and `overwrite` is false;
  // gnuplot is missing.
  Status draw(const std::string& path, const std::string& recording, bool overwrite) const;

 private:
  struct Moment {
    double time_s;
    double position_m;
    double force_N;
    bool in_contact;
  };

  const std::vector<LoadedModel>& models_;
  std::vector<Moment> moments_;
  std::vector<float> force_N_;  // all models of a moment, then the next
};

// Nothing when `path` can be drawn to; what is wrong otherwise.
Status check_plot_path(const std::string& path, bool overwrite);

}  // namespace palpate::cli
