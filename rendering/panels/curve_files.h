// The curves of the panel as files: a figure (gnuplot) and a table (CSV). `source`: scene and device.
// Thread guarantee: pure functions.
#pragma once

#include <string>

#include "rendering/panels/window_view.h"
#include "scenes/plot/plot.h"

namespace palpate {

// Two panels: force with the JND band, and difference in JND. Every point is the tick of a column (CurveColumn::tick).
Plot curve_plot(const CurveColumns& columns, const WindowView& shown, const CurveTime& time, const std::string& source);

// Every tick that the curves show, with the columns time_s,depth_m,reference_N,rendered_N and "<name>_N" for each
// model. A missing force is an empty field.
std::string curve_csv(const WindowView& shown, const CurveTime& time, const std::string& source);

}  // namespace palpate
