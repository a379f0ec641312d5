// A figure of the report as gnuplot commands, and the style that all share.
//
// Thread guarantee: value types and pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/report/report_data.h"

namespace palpate {

struct Figure {
  std::string name;     // of its files, without ending
  std::string title;
  std::string caption;  // what to conclude; escaped by the page
  bool has_times = false;
  int width = 640;
  int height = 420;
  std::string data;      // gnuplot data blocks
  std::string commands;  // from a fresh state; run once for SVG, once for PNG
};

// All of them, in the order of the page.
std::vector<Figure> make_figures(const ReportData& data);

// A whole gnuplot script that writes NAME.svg and NAME.png into the current folder.
std::string figure_script(const Figure& figure);

// An SVG as gnuplot writes it made ready to stand in an HTML page: no prologue, no
// fixed size, ids made its own with `name`, and the neutral colours replaced by the
// page's variables so that it follows light and dark.
std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title);

// Neutral colours; the page has a variable for each.
inline constexpr std::string_view kInk = "#222222";
inline constexpr std::string_view kMuted = "#6e6e6e";
inline constexpr std::string_view kGrid = "#d8d8d8";
inline constexpr std::string_view kMinorGrid = "#ececec";
inline constexpr std::string_view kBand = "#e3e3e3";
inline constexpr std::string_view kPaper = "#fefefe";
inline constexpr std::string_view kDirect = "#000001";
inline constexpr std::string_view kMeasured = "#009E73";
// Two kinds of points that are no methods.
inline constexpr std::string_view kBlue = "#0072B2";
inline constexpr std::string_view kVermilion = "#D55E00";

// The method's colour, the same as in the window.
std::string method_colour(const Method& method);
std::string model_label(const PlannedModel& model);

// "$NAME << EOD ... EOD" with one line of numbers a row.
std::string data_block(const std::string& name, const std::vector<std::vector<double>>& rows);

// An axis from `low` to `high`.
struct AxisRange {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;

  double fraction(double value) const;
  std::string text() const;  // "[low:high]"
  // "set ytics (...)" of a logarithmic axis: 1, 2 and 5 labelled where there is room,
  // the rest as minor tics. Nothing for a linear one.
  std::string tics(const std::string& axis) const;
};
// Just beyond the positive ones of `values`, at 1, 2 or 5 times a power of ten.
AxisRange log_range(const std::vector<double>& values);
// From 0 to just beyond the largest.
AxisRange zero_range(const std::vector<double>& values);

// Text in a colour, wanted at some height of a plot.
struct SideLabel {
  double fraction = 0.0;  // of the axis, 0 to 1
  std::string text;
  std::string colour;
};
// The labels in a column at `x` ("graph 1.02", "first 5000"), moved apart by at least
// `gap` of the axis so that none overlaps another. Tags count from `first_tag`.
std::string side_labels(std::vector<SideLabel> labels, const std::string& x, double gap, int first_tag);

// Quoted for gnuplot, without its markup.
std::string quoted(const std::string& text);

}  // namespace palpate
