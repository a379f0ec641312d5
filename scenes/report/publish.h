// The parts of a report and its folder: tables and figures, the page from its template and report.json. A table is one
// description for the CSV file, the page and report.json.
// Thread guarantee: slow side (does I/O, starts gnuplot).
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/plot/plot.h"

namespace palpate {

// Replaces & < > " ' by entities.
std::string escape_html(std::string_view text);

inline const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

// The format of a column on the page. CSV and report.json have the SI value in full precision.
struct TableColumn {
  std::string key;     // CSV header and JSON key with the unit at its end: "rms_error_N"
  std::string title;   // header on the page with the displayed unit: "RMS [mN]"; empty: not on the page
  double scale = 1.0;  // displayed value / stored value
  int decimals = kThreeDigits;
  int under = 0;  // the next column (1), or the next two as an interval (2), are displayed below this value

  static constexpr int kThreeDigits = -1;  // three significant digits
};

// Text, a count, a truth value, or a number. A number that is not finite becomes an empty cell, null in JSON, a dash on
// the page.
using TableCell = nlohmann::ordered_json;
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInPercent = 100.0;
inline constexpr double kInMilli = 1e3;

struct Table {
  std::string name;        // of the CSV file, without extension
  bool has_times = false;  // contains measured times, which differ from run to run
  std::vector<TableColumn> columns{};
  std::vector<std::vector<TableCell>> rows{};  // as many cells as columns

  void begin_row() { rows.emplace_back(); }
  // Adds the next cell of the last row. The first row defines the columns.
  void add(const TableColumn& column, TableCell cell) {
    if (rows.size() == 1) columns.push_back(column);
    rows.back().push_back(std::move(cell));
  }
  // Adds mean_KEY, std_KEY and max_KEY, which are not on the page.
  void add_moments(const std::string& key, const Moments& values) {
    add({"mean_" + key, ""}, values.mean());
    add({"std_" + key, ""}, values.deviation());
    add({"max_" + key, ""}, values.largest());
  }
};

// Numbers read back as the same doubles; text is quoted where needed (RFC 4180).
std::string table_csv(const Table& table);

// A list of objects, one per row. A key "a.b" is the member b of an object a; a column without a key is left out.
nlohmann::ordered_json table_json(const Table& table);

// The cells as on the page, the titles first.
std::vector<std::vector<std::string>> table_text(const Table& table);

// <div><table>...</table></div> with all text escaped. A cell that begins with ✗ is red.
std::string table_html(const Table& table);

// <li>...</li> for each line.
std::string list_html(const std::vector<std::string>& lines);

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

// What a verb that writes a page is asked for.
struct PageRequest {
  std::string out;      // the folder
  bool force = false;   // replaces an earlier page there
  std::string command;  // that made it; for the page, as the version of the program
  std::string version;
  bool json = false;  // the results are printed as JSON
};

// Writes tables/NAME.csv, the figures into the subfolder figures, report.json, which marks the folder as a report that
// may be replaced, and index.html, and commits the folder. index.html is assets/report/frame.html around TEMPLATE, with
// every {{key}} replaced: by its value in `parts`, by the table or the figure of that name, {{figures}} by all figures,
// {{style}} by style.css, {{jnd}} by kJndDefinition, {{rule}} by kBestRule, {{origin}} by command, version and what
// `parts` has of it. Errors: those of ReportFolder and draw_plots; a template is missing or has an unknown key; a file
// cannot be read or written; interrupted.
Status write_report(ReportFolder& folder, const PageRequest& request, const std::string& page_template,
                    const std::vector<Table>& tables, const std::vector<Plot>& figures,
                    std::map<std::string, std::string> parts, const nlohmann::ordered_json& report,
                    const FitControl& control);

}  // namespace palpate
