// Plots drawn into files by gnuplot, a program beside this one.
// Thread guarantee: slow side; starts a process, does I/O.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/plot/plot.h"

namespace palpate {

// A folder of its own in `parent`, gone with this object.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& parent, const std::string& name = ".palpate-figures-");
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::string& path() const noexcept { return path_; }  // empty: there is none

 private:
  std::string path_;
};

// Errors: there is no gnuplot in PATH; says what to install.
Status find_gnuplot();

// Runs `script`, a name in `folder`, there and waits. Errors: it cannot be started or fails; with the first
// line it said.
Status run_gnuplot(const std::string& folder, const std::string& script);

// NAME.gp, NAME.svg and NAME.png of every plot in `folder`, which is there. Errors: gnuplot
// is missing or fails; the disk refuses.
Status draw_plots(const std::string& folder, const std::vector<Plot>& plots);

// What was drawn into `file` of `folder`. Errors: nothing was.
Result<std::string> read_drawn(const std::string& folder, const std::string& file);

// One plot as the files `paths` of one folder, each of which ends in .svg or .png: all of them,
// whole, or none. Errors: another ending; one exists and `overwrite` is false; as above.
Status draw_plot(const Plot& plot, const std::vector<std::string>& paths, bool overwrite);
Status check_plot_path(const std::string& path, bool overwrite);

}  // namespace palpate
