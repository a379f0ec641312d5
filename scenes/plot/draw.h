// Plots drawn into files by gnuplot.
//
// Thread guarantee: slow side; starts a process, does I/O.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/plot/plot.h"

namespace palpate {

// A folder of its own in `parent`, gone with this object, or with the program.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& parent);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::string& path() const noexcept { return path_; }  // empty: there is none

 private:
  std::string path_;
  int slot_ = -1;
};

// NAME.gp, NAME.svg and NAME.png of every plot in `folder`, which is there. Errors: gnuplot
// is missing or fails; the disk refuses.
Status draw_plots(const std::string& folder, const std::vector<Plot>& plots);

// One plot as the file `path`, which ends in .svg or .png, whole or not at all. Errors: it
// does not; it exists and `overwrite` is false; as above.
Status draw_plot(const Plot& plot, const std::string& path, bool overwrite);
Status check_plot_path(const std::string& path, bool overwrite);

}  // namespace palpate
