// Layout of a panel: ranges and tics of its axes, names beside curves and lines, marks where curves are cut off.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/plot/plot.h"

namespace palpate {

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

}  // namespace palpate
