// Mouse control of a plot over time: reading of values, zoom, scrolling.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <string>
#include <vector>

#include "rendering/panels/view_state.h"
#include "rendering/ui/plot.h"
#include "scenes/live/force_history.h"

namespace palpate {

// x of the plot is in seconds since `time.zero_s`. The wheel pauses and scrolls; a drag zooms to its range and pauses;
// a double click resumes. Draws the range of the drag and the time under the mouse. Returns whether the mouse is over
// the plot.
bool handle_time_plot(const LivePlot& plot, const UiStyle& style, const ForceHistory& history, CurveTime& time,
                      double end_s);

struct Reading {
  std::string text;
  Rgb colour{0.0F};
};
// Draws a box with readings beside the time under the mouse, if the mouse is over the plot.
void draw_readings(const LivePlot& plot, const UiStyle& style, const CurveTime& time,
                   const std::vector<Reading>& readings);

struct CurveLabel {
  std::string text;
  Rgb colour{0.0F};
  float y_px = 0.0F;  // end of its curve
};
// Draws the label inside the frame at the end of the curve.
void draw_label(const LivePlot& plot, const CurveLabel& label);

}  // namespace palpate
