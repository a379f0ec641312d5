// Curves over time: ticks gathered into columns, and a plot of these with mouse control: reading of values, zoom,
// scrolling. A column has the extremes of the differences, so that no peak is lost; its forces and its predicted error
// are those of one tick.
// Thread guarantee: columns are a value type, `gather` reuses their memory; plots: the window's thread, inside a frame.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/plot.h"

namespace palpate {

struct CurveColumn {
  double time_s = 0.0;                                // loop time of its middle
  bool any = false;                                   // whether it has ticks
  TickFaultLevel fault_level = TickFaultLevel::none;  // the worst of its ticks
  // The tick in which a model is farthest from the reference. All forces that are drawn are of this one tick, so that
  // no difference is shown that did not occur.
  HistoryPoint tick;
  float jnd_N = kMissing;  // at that tick; NaN: no reference
  // By slot: extremes of (model - reference) / JND, signed; 0 out of contact, NaN without a force or a comparison.
  std::array<float, kMaxModels> low_over_jnd = no_values(), high_over_jnd = no_values();
};

// The error (95 %) that the active model predicts of its force, 0 out of contact; NaN: there is none, or there is a
// reference.
double predicted_error_N(const HistoryPoint& tick) noexcept;

class CurveColumns {
 public:
  // Gathers the ticks from `from_s` to `to_s` (loop time) into columns of a width of (to_s - from_s) / count. Borders
  // are multiples of the width, so that curves do not flicker while they scroll: there are count + 2 columns. As long
  // as the width stays the same, a call processes only new ticks.
  void gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s, double to_s,
              std::size_t count);

  const std::vector<CurveColumn>& columns() const noexcept { return columns_; }
  // The largest over all columns and slots; 0 without ticks.
  float highest_force_N() const noexcept { return highest_force_N_; }

 private:
  bool scroll(double width_s, double first, std::size_t slots, std::size_t count);
  void add(const HistoryPoint& point, const JndLine& jnd, CurveColumn& column);
  void find_highest();

  std::vector<CurveColumn> columns_;
  std::size_t slots_ = 0;
  double width_s_ = 0.0;
  double first_ = 0.0;    // left border of the first column, in widths
  double taken_s_ = 0.0;  // loop time of the last tick that was gathered
  float highest_force_N_ = 0.0F;
};

// A drag that began in `plot`, without Shift, moves blocks and numbers to `at_s`; its end returns to before.
void drag_time(CurveTime& time, const LivePlot& plot, double at_s, double end_s);

// The range of a quantity in a column; NaN: there is none.
using ColumnRange = std::function<Range(const CurveColumn&)>;

struct CurveReading {
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
  void curve(ImU32 colour, float thickness, const ColumnRange& range, const Dashes& dashes = {}) const;
  // Fills the ranges of the columns. A NaN interrupts the area.
  void fill(ImU32 colour, const ColumnRange& range) const;
  // Marks at the upper edge: a line for missed deadlines, a triangle for a fault.
  void fault_marks() const;

  // A drag moves blocks and numbers to the moment under the mouse, with Shift it zooms; the wheel scrolls; a double
  // click resumes. Draws the range of the zoom and the moment. Returns whether the mouse is over the plot.
  bool handle_mouse(const ForceHistory& history);
  // Draws a box with readings beside the time under the mouse, if the mouse is over the plot.
  void draw_readings(const std::vector<CurveReading>& readings) const;

 private:
  struct ColumnPixels {
    float x, low, high;
  };
  std::vector<std::vector<ColumnPixels>> runs(const ColumnRange& range) const;
  float time_px(double loop_time_s) const noexcept { return x_px(loop_time_s - time_.zero_s); }
  double time_under_mouse() const;
  void drag(double oldest_s);

  CurveTime& time_;
  double end_s_;
  const CurveColumns& columns_;
};

}  // namespace palpate
