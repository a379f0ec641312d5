#include "rendering/panels/time_plot.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"

namespace palpate {

constexpr float kDrag_px = 6.0F;     // a shorter movement is a click
constexpr double kWheelShare = 0.1;  // one step of the wheel scrolls by this share of the visible span

TimePlot::TimePlot(const UiStyle& style, const ImVec2& size, const Range& y, const char* y_unit, CurveTime& time,
                   double end_s, const CurveColumns& columns)
    : LivePlot(style, size, {{end_s - time.shown_s - time.zero_s, end_s - time.zero_s}, y, "s", y_unit}),
      time_(time),
      end_s_(end_s),
      columns_(columns) {}

// The parts of a curve between interruptions.
std::vector<std::vector<TimePlot::ColumnPixels>> TimePlot::runs(const ColumnRange& range) const {
  std::vector<std::vector<ColumnPixels>> runs(1);
  for (const CurveColumn& column : columns_.columns()) {
    if (!column.any) continue;
    const Range values = range(column);
    if (std::isnan(values.from) || std::isnan(values.to)) {
      runs.emplace_back();
    } else {
      runs.back().push_back({time_px(column.tick.loop_time_s), y_px(values.from), y_px(values.to)});
    }
  }
  return runs;
}

void TimePlot::curve(ImU32 colour, float thickness, const ColumnRange& range) const {
  std::vector<ImVec2> points;
  for (const std::vector<ColumnPixels>& run : runs(range)) {
    points.clear();
    for (const auto& [x, low, high] : run) {
      // The nearer end first, because a polyline that reverses its direction has no width there.
      const bool falling = !points.empty() && low - points.back().y > points.back().y - high;
      points.emplace_back(x, falling ? high : low);
      if (low - high > 1.5F) points.emplace_back(x, falling ? low : high);
    }
    line(points, colour, thickness);
  }
}

void TimePlot::fill(ImU32 colour, const ColumnRange& range) const {
  for (const std::vector<ColumnPixels>& run : runs(range)) {
    std::vector<ImVec2> upper, lower;
    for (const auto& [x, low, high] : run) {
      upper.emplace_back(x, high);
      lower.emplace_back(x, low);
    }
    band(upper, lower, colour);
  }
}

void TimePlot::fault_marks() const {
  const float size = 6.0F * style_.scale();
  for (const CurveColumn& column : columns_.columns()) {
    const float x = time_px(column.time_s);
    if (column.fault_level == TickFaultLevel::late) {
      list().AddLine({x, top()}, {x, top() + size}, ink(style_.colours().quiet));
    } else if (column.fault_level == TickFaultLevel::alarm) {
      list().AddTriangleFilled({x - size, top()}, {x + size, top()}, {x, top() + 1.6F * size},
                               ink(style_.colours().fault));
    }
  }
}

double TimePlot::time_under_mouse() const {
  return x_at(std::clamp(ImGui::GetIO().MousePos.x, left(), right())) + time_.zero_s;
}

void TimePlot::drag() {
  if (hovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) time_.drag_from_s = time_under_mouse();
  if (std::isnan(time_.drag_from_s)) return;
  const float from_px = time_px(time_.drag_from_s);
  const float to_px = time_px(time_under_mouse());
  const bool dragged = std::abs(to_px - from_px) > kDrag_px;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (dragged) time_.zoom(time_.drag_from_s, time_under_mouse());
    time_.drag_from_s = std::nan("");
  } else if (dragged) {
    list().AddRectFilled({std::min(from_px, to_px), top()}, {std::max(from_px, to_px), bottom()},
                         ink(style_.colours().text, 0.10F));
  }
}

bool TimePlot::handle_mouse(const ForceHistory& history) {
  drag();
  if (hovered()) {
    time_.hover_s = time_under_mouse();
    if (const float wheel = ImGui::GetIO().MouseWheel; wheel != 0.0F) {
      time_.pause(end_s_);
      time_.scroll_back(kWheelShare * time_.shown_s * wheel, history.size() > 0 ? history[0].loop_time_s : end_s_);
    }
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
      time_.run();
      time_.drag_from_s = std::nan("");
    }
  }
  if (!std::isnan(time_.hover_s)) {
    const float x = time_px(time_.hover_s);
    list().AddLine({x, top()}, {x, bottom()}, ink(style_.colours().quiet));
  }
  return hovered();
}

void TimePlot::draw_readings(const std::vector<Reading>& readings) const {
  if (!hovered() || std::isnan(time_.hover_s)) return;
  const std::string heading = "at " + fixed(time_.hover_s - time_.zero_s, 3) + " s";
  const float line = ImGui::GetTextLineHeight();
  float width = ImGui::CalcTextSize(heading.c_str()).x;
  for (const Reading& reading : readings) width = std::max(width, ImGui::CalcTextSize(reading.text.c_str()).x + line);
  const float pad = 0.4F * line;
  const float mouse_px = time_px(time_.hover_s);
  // The text is on the side with more room, so that it does not hide the curve under the mouse.
  const bool at_left = mouse_px > 0.5F * (left() + right());
  const ImVec2 low(at_left ? mouse_px - width - 3.0F * pad : mouse_px + pad, top());
  const ImVec2 high(low.x + width + 2.0F * pad, low.y + line * static_cast<float>(readings.size() + 1) + 2.0F * pad);
  ImDrawList& front = *ImGui::GetForegroundDrawList();
  front.AddRectFilled(low, high, ink(style_.colours().panel, 0.92F), 4.0F);
  front.AddRect(low, high, ink(style_.colours().grid), 4.0F);
  float y = low.y + pad;
  front.AddText({low.x + pad, y}, ink(style_.colours().text), heading.c_str());
  for (const Reading& reading : readings) {
    y += line;
    front.AddRectFilled({low.x + pad, y + 0.3F * line}, {low.x + pad + 0.5F * line, y + 0.8F * line},
                        ink(reading.colour), 2.0F);
    front.AddText({low.x + pad + line, y}, ink(style_.colours().text), reading.text.c_str());
  }
}

void TimePlot::draw_name(const std::string& name, const Rgb& colour, float y_px) const {
  const float line = ImGui::GetTextLineHeight();
  const float width = ImGui::CalcTextSize(name.c_str()).x;
  // The name is above the end of the curve, or below it if there is no room.
  const float y = y_px - 1.2F * line > top() ? y_px - 1.2F * line : y_px + 0.2F * line;
  list().AddText({right() - width - 0.3F * line, y}, ink(colour), name.c_str());
}

}  // namespace palpate
