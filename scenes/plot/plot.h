// A figure as data: panels of series against two axes. plot_script converts it to one gnuplot script that contains
// the data and draws NAME.svg and NAME.png in the folder where it is run.
// The names of series are in a legend above the panels, or with `names_at_ends` beside the curves. Tics of
// logarithmic axes have SI prefixes (300 mN, 2 us, 3 kN). Lines that exceed a given limit of the y axis are marked at
// the edge (below). Fonts, tics and neutral colours are in assets/figures/style.gp.
// Thread guarantee: value types and pure functions, slow side; plot_script reads the asset, ScratchFolder and what
// draws does I/O and starts a process.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"

namespace palpate {

// 0xRRGGBB. Black stands for the ink colour of the page, which is light on a dark page.
using Hue = std::uint32_t;
inline constexpr Hue kInkColour = 0x000000;
inline constexpr Hue kMutedColour = 0x6E6E6E;
inline constexpr Hue kMeasuredColour = 0x009E73;

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

enum class Mark {
  line,
  dashed,
  curve,         // a line through points
  hollow_curve,  // with points filled with the background colour
  bars,          // points with bars from `low` to `high` and from `left` to `right`
  hollow_bars,   // with hollow points
  square_bars,   // with squares
  up,            // small triangles at the edge
  down,
  area,  // grey, from `low` to `high` at each x
};

// A point, and the ends of its bars or area. A NaN in y and low is a gap in a line; a NaN end is no bar.
struct PlotRow {
  double x = 0.0, y = 0.0, low = kNoValue, high = kNoValue, left = kNoValue, right = kNoValue;
};

struct Series {
  std::string name;  // in the legend, once for all panels; empty: not in the legend
  Hue colour = kInkColour;
  Mark mark = Mark::line;
  std::vector<PlotRow> rows;
};

struct Axis {
  std::string title{};  // with the unit, except on a logarithmic axis with `unit`
  std::string unit{};   // for the tics of a logarithmic axis, which get a prefix; empty: plain numbers
  bool logarithmic = false;
  double low = kNoValue;   // NaN: from the data
  double high = kNoValue;  // NaN: from the data
};

// A line across a panel with its name.
struct Level {
  double value = 0.0;
  std::string text;
  bool vertical = false;
};

struct Panel {
  std::string title{};
  Axis x{}, y{};
  std::vector<Series> series{};
  std::vector<Level> levels{};
  bool names_at_ends = false;
};

struct Plot {
  std::string name{};   // of its files
  int columns = 1;      // panels are placed row by row
  double width = 1.0;   // 1: 800 pixels
  double height = 1.0;  // of a row of panels; 1: 230 pixels
  std::vector<Panel> panels{};
  std::string caption{};  // on a page; plain text
};

// Errors: the asset is missing.
Result<std::string> plot_script(Plot plot);

// Layout of a panel: ranges and tics of its axes, names beside curves and lines, marks where curves are cut off.

struct AxisRange {
  double low = 0.0, high = 1.0;
};

// The range of the x axis, or of the y axis when `vertical`: the limits of the axis where they are given, else those
// of the data and levels with a margin.
AxisRange range_of(const Panel& panel, bool vertical);

// The labelled values (tics) of a logarithmic axis, at least two and at most about `most`: decades, with steps such as
// 2 and 5 between few decades.
std::vector<double> log_tics(const AxisRange& range, std::size_t most);

// A name beside a point; x and y are fractions of the panel.
struct NameTag {
  std::string text;
  Hue colour = kInkColour;
  double x = 1.0, y = 0.0;
  bool beside_panel = false;
  bool begins_here = true;  // the text begins at x; false: it ends there
};

// The names of horizontal levels and, with `names_at_ends`, of the series: of a series of one point at the point,
// between its bars, of all others beside the panel, where they are moved up and down so that they do not overlap.
// `line`: height of a line of text, `character`: width of a letter, both as fractions of the panel.
std::vector<NameTag> name_tags(const Panel& panel, double line, double character);

// Marks at the edge of the panel, one for each part of a line that is beyond a given limit of the y axis.
std::vector<Series> cut_marks(const Panel& panel);

// The forces of models beside a measured force over time, as panels of a figure.

struct ComparedMoment {
  double time_s = 0.0, measured_N = 0.0;
  bool in_contact = false;
  std::vector<double> force_N;  // one per model

  // Model minus measurement over the JND; none in the air.
  double over_jnd(std::size_t model, const JndLine& jnd) const {
    return in_contact ? (force_N[model] - measured_N) / jnd.at(measured_N) : kNoValue;
  }
};

struct ComparedModel {
  Series curve;  // without rows
  JndLine jnd;
};

// Two panels: the forces, and below them each model's difference from the measured force in JND, in contact, with the
// band of one JND. Of many moments the one with the largest error of each group is drawn, so that a bad sample is
// visible. The first model is on top, and its curve is never cut. `moments`: at least one.
std::vector<Panel> compared_forces(const std::string& title, const std::vector<ComparedModel>& models,
                                   const std::vector<ComparedMoment>& moments);

// Merges curves that are equal, because only one of them would be visible. Areas stay.
void merge_equal(std::vector<Series>& series);

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

// Plots are drawn by the external program gnuplot. Errors: it is not in PATH; says what to install.
Status find_gnuplot();

// Writes NAME.gp, NAME.svg and NAME.png of every plot into `folder`, which exists. Errors: gnuplot is missing or
// fails; a file cannot be written.
Status draw_plots(const std::string& folder, const std::vector<Plot>& plots);

// Draws one plot into the file `path`, which ends in .svg or .png. Writes the whole file or nothing. Errors: those of
// plot_ending_error, AtomicFile::create and draw_plots.
Status draw_plot(const Plot& plot, const std::string& path, bool overwrite);
// What is wrong with the ending of `path`; empty: nothing.
std::string plot_ending_error(const std::string& path);

}  // namespace palpate
