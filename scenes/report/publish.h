// Writes the folder of a report: tables, figures, the page from its template and report.json.
// Thread guarantee: slow side (does I/O, starts gnuplot).
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "scenes/plot/draw.h"
#include "scenes/report/table.h"

namespace palpate {

// A folder that gets its final name only when it is complete. Files are written into a hidden folder beside `path`,
// which `commit` renames. The destructor removes the hidden folder if it was not committed.
class ReportFolder {
 public:
  // Errors: `path` exists and `overwrite` is false, or it is not a folder, or it has files but no report.json and so
  // is no earlier report; the parent folder is missing or not writable.
  static Result<ReportFolder> create(const std::string& path, bool overwrite);

  // Writes a whole file and creates its subfolder where necessary.
  Status write(const std::string& name, std::string_view text) const;
  std::string path_of(const std::string& name) const { return temporary_->path() + "/" + name; }

  // Moves the folder to its final name and removes an earlier report there.
  Status commit();

 private:
  ReportFolder() = default;
  std::string path_;
  std::unique_ptr<ScratchFolder> temporary_;
};

struct Figure {
  Plot plot;
  std::string caption;  // plain text
  std::string svg{};    // set by write_parts
};

// Writes tables/NAME.csv, draws the figures into the subfolder figures and sets their `svg`. Errors: those of
// draw_plots; a file cannot be read or written; interrupted.
Status write_parts(const ReportFolder& folder, const std::vector<Table>& tables, std::vector<Figure>& figures,
                   const FitControl& control);

std::string figure_html(const Figure& figure);

// Returns assets/report/NAME with every {{key}} replaced by its value, and {{style}} by style.css. Errors: a template
// is missing, or has an unknown key.
Result<std::string> fill_page(const std::string& name, std::map<std::string, std::string> values);

// Writes index.html and report.json, which marks the folder as a report that may be replaced, and commits the folder.
// Errors: those of ReportFolder; interrupted.
Status publish(ReportFolder& folder, const std::string& page, const nlohmann::ordered_json& report,
               const FitControl& control);

}  // namespace palpate
