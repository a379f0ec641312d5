// Where things of a panel go: ranges and tics of its axes, names beside curves and lines, marks of what is cut.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/plot/plot.h"

namespace palpate {

struct AxisRange {
  double low = 0.0;
  double high = 1.0;
};

// Of the x axis, or of the y axis when `vertical`: what is asked for, and else what the data and the named lines
// have.
AxisRange range_of(const Panel& panel, bool vertical);

// Labelled values inside `range`, at least two and at most about `most`: of a logarithmic axis decades, with 2 and
// 5 or more steps where decades are few; else multiples of 1, 2 or 5 times a power of ten.
std::vector<double> tics_of(const Axis& axis, const AxisRange& range, std::size_t most);

// Where `value` is on the axis, 0 to 1.
double fraction_of(const Axis& axis, const AxisRange& range, double value);

// A name beside a point, x and y as fractions of the panel.
struct NameTag {
  std::string text;
  Hue colour = kInkColour;
  double x = 1.0;
  double y = 0.0;
  bool beside_panel = false;
};

// The names of levels and, where the panel asks for it, of its series: beside the panel for those that end at its
// edge, else beside their last point. Moved up and down until no two overlap; `line`: the height of one over that of
// the panel, `character`: the width of a letter over that of the panel.
std::vector<NameTag> name_tags(const Panel& panel, double line, double character);

// A series of marks at the edge for each stretch of a line that leaves the axis as it was asked for.
std::vector<Series> cut_marks(const Panel& panel);

}  // namespace palpate
