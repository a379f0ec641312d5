// Draws plots into files with the external program gnuplot.
// Thread guarantee: slow side; starts a process, does I/O.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/plot/plot.h"

namespace palpate {

// A temporary folder in `parent`, which the destructor removes.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& parent, const std::string& name = ".palpate-figures-");
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::string& path() const noexcept { return path_; }  // empty: it could not be created

 private:
  std::string path_;
  int lock_ = -1;  // of the folder: the system releases it when the program ends
};

// Errors: there is no gnuplot in PATH; says what to install.
Status find_gnuplot();

// Writes NAME.gp, NAME.svg and NAME.png of every plot into `folder`, which exists. Errors: gnuplot is missing or
// fails; a file cannot be written.
Status draw_plots(const std::string& folder, const std::vector<Plot>& plots);

// Draws one plot into the file `path`, which ends in .svg or .png. Writes the whole file or nothing. Errors: those of
// check_plot_path and draw_plots.
Status draw_plot(const Plot& plot, const std::string& path, bool overwrite);
// Errors: `path` does not end in .svg or .png; those of AtomicFile::create.
Status check_plot_path(const std::string& path, bool overwrite);

}  // namespace palpate
