// The curves of the panel as files: a figure (gnuplot) and a table (CSV).
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "rendering/ui/curves.h"
#include "scenes/live/force_history.h"
#include "scenes/plot/plot.h"

namespace palpate {

struct CurveModel {
  std::size_t slot = 0;
  std::string name;
  Hue colour = kInkColour;
};

struct CurveSource {
  std::string title;      // scene and device
  std::string reference;  // in words
  JndLine jnd;
  double zero_s = 0.0;  // loop time at 0 of the time axis
  double from_s = 0.0, to_s = 0.0;
  std::vector<CurveModel> models;
};

// Two panels: force with the JND band, and difference in JND. Every point is the tick of a column (CurveColumn::tick).
Plot curve_plot(const CurveColumns& columns, const CurveSource& source);

// Every tick from from_s to to_s with the columns time_s,depth_m,reference_N,rendered_N and
// "<name>_N" for each model. A missing force is an empty field.
std::string curve_csv(const ForceHistory& history, const CurveSource& source);

}  // namespace palpate
