// Draws the columns of a plot over time as curves.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <cmath>
#include <vector>

#include "rendering/ui/curves.h"
#include "rendering/ui/plot.h"

namespace palpate {

// x of the plot is loop time - `zero_s`.
struct CurvePainter {
  const LivePlot& plot;
  const std::vector<CurveColumn>& columns;
  double zero_s = 0.0;

  // A curve through the range between two values of each column. A NaN interrupts it.
  template <typename Low, typename High>
  void curve(ImU32 colour, float thickness, Low low, High high) const;
  template <typename Value>
  void curve(ImU32 colour, float thickness, Value value) const {
    curve(colour, thickness, value, value);
  }
  // The reference -/+ one JND.
  void jnd_band(ImU32 colour) const;
  // Fills the area between two values of each column. A NaN interrupts it.
  template <typename Low, typename High>
  void band(ImU32 colour, Low low, High high) const;
  // Marks at the upper edge: a line for missed deadlines, a triangle for a fault.
  void fault_marks(ImU32 late, ImU32 alarm, float size_px) const;
};

template <typename Low, typename High>
void CurvePainter::band(ImU32 colour, Low low, High high) const {
  std::vector<ImVec2> upper;
  std::vector<ImVec2> lower;
  const auto flush = [&] {
    plot.band(upper, lower, colour);
    upper.clear();
    lower.clear();
  };
  for (const CurveColumn& column : columns) {
    if (!column.any) continue;
    const auto bottom = static_cast<double>(low(column));
    const auto top = static_cast<double>(high(column));
    if (std::isnan(bottom) || std::isnan(top)) {
      flush();
      continue;
    }
    const float x = plot.x_px(column.tick.loop_time_s - zero_s);
    upper.emplace_back(x, plot.y_px(top));
    lower.emplace_back(x, plot.y_px(bottom));
  }
  flush();
}

template <typename Low, typename High>
void CurvePainter::curve(ImU32 colour, float thickness, Low low, High high) const {
  std::vector<ImVec2> points;
  // A level part needs its two ends only.
  const auto add = [&points](float x, float y) {
    constexpr float kLevel_px = 0.2F;
    const std::size_t n = points.size();
    if (n > 1 && std::abs(points[n - 1].y - y) < kLevel_px && std::abs(points[n - 2].y - y) < kLevel_px) {
      points[n - 1].x = x;
    } else {
      points.emplace_back(x, y);
    }
  };
  for (const CurveColumn& column : columns) {
    if (!column.any) continue;
    const auto bottom = static_cast<double>(low(column));
    const auto top = static_cast<double>(high(column));
    if (std::isnan(bottom) || std::isnan(top)) {
      plot.line(points, colour, thickness);
      points.clear();
      continue;
    }
    const float x = plot.x_px(column.tick.loop_time_s - zero_s);
    const float y_low = plot.y_px(bottom);
    const float y_high = plot.y_px(top);
    // The nearer end first, because a polyline that reverses its direction has no width there.
    const bool falling = !points.empty() && y_low - points.back().y > points.back().y - y_high;
    add(x, falling ? y_high : y_low);
    if (y_low - y_high > 1.5F) add(x, falling ? y_low : y_high);
  }
  plot.line(points, colour, thickness);
}

}  // namespace palpate
