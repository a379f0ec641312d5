// What the curves show, as files: a figure, which gnuplot draws, and a table (CSV).
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

// What both say of themselves.
struct CurveSource {
  std::string scene;
  std::string device;
  std::string reference;  // in words
  JndLine jnd;
  double zero_s = 0.0;  // loop time of the axis' 0
  std::vector<CurveModel> models;
};

// Force with the JND band above, difference in JND below: of every column of the screen one
// tick, the same for all curves, and a row of the table.
Plot curve_plot(const CurveColumns& columns, const CurveSource& source, double from_s, double to_s);

// Every tick between the two loop times: time_s,depth_m,reference,reference_N,rendered_N
// and one column a model, "<name>_N"; a force that is not there is an empty field.
std::string curve_csv(const ForceHistory& history, const CurveSource& source, double from_s, double to_s);

}  // namespace palpate
