// A figure of the report: tables and settings for a gnuplot script of
// assets/figures/report, which stands beside them in the report's folder, so that a
// reader can redraw it.
//
// Thread guarantee: value types and pure functions; figure_files reads the assets.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "scenes/report/data/report_data.h"
#include "scenes/report/data/table.h"

namespace palpate {

struct Figure {
  std::string name;     // of its files, without ending; of its script in the assets
  std::string title;
  std::string caption;  // what to conclude; escaped by the page
  bool has_times = false;
  int width = 640;
  int height = 420;
  std::vector<Table> data;   // name.csv, name_labels.csv ...; a row without cells breaks a line
  std::string settings;      // gnuplot assignments, name.set; by set_number and set_text
  std::string script;        // another figure's script; empty: its own

  void set_number(const std::string& variable, double value);
  void set_text(const std::string& variable, const std::string& text);
};

// All of them, in the order of the page.
std::vector<Figure> make_figures(const ReportData& data);

// Every file that the figures need in their folder, by name. Errors: a script is missing
// in the assets.
Result<std::map<std::string, std::string>> figure_files(const std::vector<Figure>& figures);

// An SVG as gnuplot writes it made ready to stand in an HTML page: no prologue, no
// fixed size, ids made its own with `name`, and the neutral colours replaced by the
// page's variables so that it follows light and dark.
std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title);

// Neutral colours; the page has a variable for each, style.gp the same values.
inline constexpr std::string_view kInk = "#222222";
inline constexpr std::string_view kMuted = "#6e6e6e";
inline constexpr std::string_view kGrid = "#d8d8d8";
inline constexpr std::string_view kMinorGrid = "#ececec";
inline constexpr std::string_view kBand = "#e3e3e3";
inline constexpr std::string_view kPaper = "#fefefe";
inline constexpr std::string_view kDirect = "#000001";

// The model's colour, that of its method in the window: 0xRRGGBB.
double model_colour(const PlannedModel& model);
std::string model_label(const PlannedModel& model);

// An axis from `low` to `high`.
struct AxisRange {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;

  double fraction(double value) const;
  double value(double fraction) const;
  // "set ytics (...)" of a logarithmic axis: 1, 2 and 5 labelled where there is room,
  // the rest as minor tics. Nothing for a linear one.
  std::string tics(const std::string& axis) const;
};
// Around the positive ones of `values`, beyond them by these factors.
AxisRange cropped_log_range(const std::vector<double>& values, double below, double above);
// The same by 1.15, out to 1, 2 or 5 times a power of ten.
AxisRange log_range(const std::vector<double>& values);
// From 0 to just beyond the largest.
AxisRange zero_range(const std::vector<double>& values);

// Heights of labels, fractions of an axis, moved apart by at least `gap` so that none
// overlaps another; in the order given.
std::vector<double> spread_labels(const std::vector<double>& wanted, double gap);

// Quoted for gnuplot, without its markup.
std::string quoted(const std::string& text);

}  // namespace palpate
