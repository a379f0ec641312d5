// A plot over time: curves of columns, and mouse control: reading of values, zoom, scrolling.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rendering/panels/view_state.h"
#include "rendering/ui/curves.h"
#include "rendering/ui/plot.h"

namespace palpate {

// The range of a quantity in a column; NaN: there is none.
using ColumnRange = std::function<Range(const CurveColumn&)>;

struct Reading {
  std::string text;
  Rgb colour{0.0F};
};

// The x axis has loop time - CurveTime::zero_s, s.
class TimePlot : public LivePlot {
 public:
  // `end_s`: loop time at the right edge. All references outlive the plot.
  TimePlot(const UiStyle& style, const ImVec2& size, const Range& y, const char* y_unit, CurveTime& time, double end_s,
           const CurveColumns& columns);

  // A curve through the ranges of the columns. A NaN interrupts it.
  void curve(ImU32 colour, float thickness, const ColumnRange& range) const;
  // Fills the ranges of the columns. A NaN interrupts the area.
  void fill(ImU32 colour, const ColumnRange& range) const;
  // Marks at the upper edge: a line for missed deadlines, a triangle for a fault.
  void fault_marks() const;

  // The wheel pauses and scrolls; a drag zooms to its range and pauses; a double click resumes. Draws the range of the
  // drag and the time under the mouse. Returns whether the mouse is over the plot.
  bool handle_mouse(const ForceHistory& history);
  // Draws a box with readings beside the time under the mouse, if the mouse is over the plot.
  void draw_readings(const std::vector<Reading>& readings) const;
  // Draws the name of a curve inside the frame at its end, which is at `y_px`.
  void draw_name(const std::string& name, const Rgb& colour, float y_px) const;

 private:
  struct ColumnPixels {
    float x, low, high;
  };
  std::vector<std::vector<ColumnPixels>> runs(const ColumnRange& range) const;
  float time_px(double loop_time_s) const noexcept { return x_px(loop_time_s - time_.zero_s); }
  double time_under_mouse() const;
  void drag();

  CurveTime& time_;
  double end_s_;
  const CurveColumns& columns_;
};

}  // namespace palpate
