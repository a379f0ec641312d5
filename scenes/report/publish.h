// Writes the folder of a report: tables, figures, the page from its template and report.json.
// Thread guarantee: slow side (does I/O, starts gnuplot).
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "scenes/plot/draw.h"
#include "scenes/report/table.h"

namespace palpate {

// Replaces & < > " ' by entities.
std::string escape_html(std::string_view text);

// Converts an SVG drawing of gnuplot for a page. Removes the prologue and the fixed size, prefixes ids with `name`, and
// replaces the neutral colours of assets/figures/style.gp by the page's CSS variables (--ink, --muted, --grid, --band,
// --paper), so that the drawing follows the light or dark theme. Returns an empty string where `svg` is no SVG.
std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title);

// A folder that gets its final name only when it is complete. Files are written into a hidden folder beside `path`,
// which the first `write` makes and `commit` renames. The destructor removes the hidden folder if it was not committed;
// that of a killed program is removed when the next one writes beside it.
class ReportFolder {
 public:
  // Errors: `path` exists and `overwrite` is false, or it is not a folder, or it has files but no report.json and so
  // is no earlier report; the parent folder is missing or not writable.
  static Result<ReportFolder> create(const std::string& path, bool overwrite);

  // Writes a whole file and creates its subfolder where necessary.
  Status write(const std::string& name, std::string_view text);
  // Where a file is before `commit`; after the first `write`.
  std::string path_of(const std::string& name) const { return temporary_->path() + "/" + name; }

  // Moves the folder to its final name and removes an earlier report there.
  Status commit();

 private:
  ReportFolder() = default;
  Status open();
  std::string path_;
  std::unique_ptr<ScratchFolder> temporary_;
};

struct Figure {
  Plot plot;
  std::string caption;  // plain text
};

// Writes tables/NAME.csv, the figures into the subfolder figures, report.json, which marks the folder as a report that
// may be replaced, and index.html, and commits the folder. index.html is assets/report/TEMPLATE with every {{key}}
// replaced: by its value in `parts`, by the table or the figure of that name, {{figures}} by all figures, {{style}} by
// style.css. Errors: those of ReportFolder and draw_plots; a template is missing or has an unknown key; a file cannot
// be read or written; interrupted.
Status write_report(ReportFolder& folder, const std::string& page_template, const std::vector<Table>& tables,
                    const std::vector<Figure>& figures, std::map<std::string, std::string> parts,
                    const nlohmann::ordered_json& report, const FitControl& control);

}  // namespace palpate
