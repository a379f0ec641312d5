// A figure as data: panels of series against two axes. Out comes one gnuplot script that
// holds its own data and draws NAME.svg and NAME.png wherever it is run.
//
// Names stand at the ends of curves where a panel asks for it, else in one legend above the panels, in their
// colours; tics of logarithmic axes carry SI prefixes (300 mN, 2 us, 3 kN). What leaves an axis whose range was
// given is marked at the edge (layout.h).
// Type, tics and neutral colours: assets/figures/style.gp.
// Thread guarantee: value types and pure functions; plot_script reads the asset.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// 0xRRGGBB; black is the ink of the page, light on dark.
using Hue = std::uint32_t;
inline constexpr Hue kInkColour = 0x000000;
inline constexpr Hue kMutedColour = 0x6E6E6E;
inline constexpr Hue kMeasuredColour = 0x009E73;

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

enum class Mark {
  line,
  dashed,
  points,
  hollow,        // points with the paper inside
  curve,         // a line through points
  hollow_curve,  // likewise
  bars,          // points with bars from `low` to `high` and from `left` to `right`
  hollow_bars,   // likewise
  up,            // small triangles at the edge
  down,
  area,  // grey, from `low` to `high` at each x
};

// x and y; what bars and area go from and to. NaN: a gap; of bars: none.
struct PlotRow {
  double x = 0.0;
  double y = 0.0;
  double low = kNoValue;
  double high = kNoValue;
  double left = kNoValue;
  double right = kNoValue;
};

struct Series {
  std::string name;  // in the legend, once for all panels; empty: not there
  Hue colour = kInkColour;
  Mark mark = Mark::line;
  std::vector<PlotRow> rows;
};

struct Axis {
  std::string title;  // with the unit, but of a logarithmic axis with one, whose tics carry it
  std::string unit;   // of a logarithmic axis: behind every tic, with a prefix; empty: plain numbers
  bool logarithmic = false;
  double low = kNoValue;  // NaN: as the data have it
  double high = kNoValue;
};

// A line across a panel, named on it.
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
  int columns = 1;      // panels go row by row
  double width = 1.0;   // over that of a page
  double height = 1.0;  // of a row of panels, over the usual one
  std::vector<Panel> panels;
};

// Errors: the asset is missing.
Result<std::string> plot_script(const Plot& plot);

}  // namespace palpate
