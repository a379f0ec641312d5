// A plot over time as an instrument: the mouse reads values, zooms, goes back and forth.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <string>
#include <vector>

#include "rendering/panels/view_state.h"
#include "rendering/ui/plot.h"
#include "scenes/live/force_history.h"

namespace palpate {

// x of the plot: seconds since `time.zero_s`.
// Wheel: back in time. Drag: shows what was dragged over, standing still. Double click:
// runs again. Draws what is dragged over, and the time under the mouse. Whether the
// mouse is over it.
bool handle_time_plot(const LivePlot& plot, const UiStyle& style, const ForceHistory& history, CurveTime& time,
                      double end_s);

struct Reading {
  std::string text;
  Rgb colour{0.0F};
};
// Beside the time under the mouse, on the plot that the mouse is over.
void draw_readings(const LivePlot& plot, const UiStyle& style, const CurveTime& time,
                   const std::vector<Reading>& readings);

struct CurveLabel {
  std::string text;
  Rgb colour{0.0F};
  float y_px = 0.0F;  // where its curve ends
};
// Inside the frame, where the curve ends.
void draw_label(const LivePlot& plot, const CurveLabel& label);

}  // namespace palpate
