#include "scenes/plot/draw.h"

#include <stdlib.h>

#include <filesystem>

#include "engine/base/atomic_file.h"
#include "engine/base/temporary_paths.h"
#include "engine/base/whole_file.h"
#include "scenes/plot/gnuplot.h"

namespace palpate {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder(const std::string& parent) : path_(parent + "/.palpate-figures-XXXXXX") {
  if (mkdtemp(path_.data()) == nullptr) {
    path_.clear();
    return;
  }
  slot_ = register_temporary(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  unregister_temporary(slot_);
}

Status draw_plots(const std::string& folder, const std::vector<Plot>& plots) {
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) return gnuplot.error();
  std::vector<std::string> scripts;
  for (const Plot& plot : plots) {
    const auto script = plot_script(plot);
    if (!script) return script.error();
    scripts.push_back(plot.name + ".gp");
    if (const Status status = write_file_atomically(folder + "/" + scripts.back(), *script, true); !status)
      return status;
  }
  return run_gnuplot(*gnuplot, folder, scripts);
}

Status check_plot_path(const std::string& path, bool overwrite) {
  const std::string ending = fs::path(path).extension().string();
  if (ending != ".svg" && ending != ".png") {
    return Error{"found --plot " + path + ", expected a file that ends in .svg or .png"};
  }
  std::error_code error;
  if (!overwrite && fs::exists(path, error)) return Error{path + " exists; pass --force to replace it"};
  return {};
}

Status draw_plot(const Plot& plot, const std::string& path, bool overwrite) {
  if (const Status status = check_plot_path(path, overwrite); !status) return status;
  const fs::path parent = fs::path(path).parent_path();
  const ScratchFolder scratch(parent.empty() ? "." : parent.string());
  if (scratch.path().empty()) return Error{"cannot write " + path + ": no folder can be made beside it"};
  if (const Status status = draw_plots(scratch.path(), {plot}); !status) return status;
  const auto drawn = read_whole_file(scratch.path() + "/" + plot.name + fs::path(path).extension().string());
  if (!drawn || drawn->empty())
    return Error{"gnuplot wrote no " + path + "; check that it is gnuplot 5.4 or newer (gnuplot-nox)"};
  return write_file_atomically(path, *drawn, overwrite);
}

}  // namespace palpate
