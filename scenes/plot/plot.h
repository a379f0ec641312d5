// A figure as data: panels of series against two axes. plot_script converts it to one gnuplot script that contains
// the data and draws NAME.svg and NAME.png in the folder where it is run.
// The names of series are in a legend above the panels, or with `names_at_ends` beside the curves. Tics of
// logarithmic axes have SI prefixes (300 mN, 2 us, 3 kN). Lines that exceed a given limit of the y axis are marked at
// the edge (layout.h). Fonts, tics and neutral colours are in assets/figures/style.gp.
// Thread guarantee: value types and pure functions; plot_script reads the asset.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/result.h"

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
  std::string title;  // with the unit, except on a logarithmic axis with `unit`
  std::string unit;   // for the tics of a logarithmic axis, which get a prefix; empty: plain numbers
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
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<Level> levels;
  bool names_at_ends = false;
};

struct Plot {
  std::string name;     // of its files
  int columns = 1;      // panels are placed row by row
  double width = 1.0;   // 1: 800 pixels
  double height = 1.0;  // of a row of panels; 1: 230 pixels
  std::vector<Panel> panels;
};

// Errors: the asset is missing.
Result<std::string> plot_script(Plot plot);

}  // namespace palpate
