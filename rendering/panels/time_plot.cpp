#include "rendering/panels/time_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace palpate {
namespace {

constexpr float kDrag_px = 6.0F;     // a shorter movement is a click
constexpr double kWheelShare = 0.1;  // one step of the wheel scrolls by this share of the visible span

double time_under_mouse(const LivePlot& plot, const CurveTime& time) {
  const float px = std::clamp(ImGui::GetIO().MousePos.x, plot.left(), plot.right());
  return plot.x_at(px) + time.zero_s;
}

void drag(const LivePlot& plot, const UiStyle& style, CurveTime& time) {
  if (plot.hovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) time.drag_from_s = time_under_mouse(plot, time);
  if (std::isnan(time.drag_from_s)) return;
  const double to_s = time_under_mouse(plot, time);
  const float from_px = plot.x_px(time.drag_from_s - time.zero_s);
  const float to_px = plot.x_px(to_s - time.zero_s);
  const bool dragged = std::abs(to_px - from_px) > kDrag_px;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (dragged) time.zoom(time.drag_from_s, to_s);
    time.drag_from_s = std::nan("");
  } else if (dragged) {
    plot.list().AddRectFilled({std::min(from_px, to_px), plot.top()}, {std::max(from_px, to_px), plot.bottom()},
                              ink(style.colours().text, 0.10F));
  }
}

}  // namespace

bool handle_time_plot(const LivePlot& plot, const UiStyle& style, const ForceHistory& history, CurveTime& time,
                      double end_s) {
  const double oldest_s = history.size() > 0 ? history[0].loop_time_s : end_s;
  drag(plot, style, time);
  if (plot.hovered()) {
    time.hover_s = time_under_mouse(plot, time);
    if (const float wheel = ImGui::GetIO().MouseWheel; wheel != 0.0F) {
      time.pause(end_s);
      time.scroll_back(kWheelShare * time.shown_s * static_cast<double>(wheel), oldest_s);
    }
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
      time.run();
      time.drag_from_s = std::nan("");
    }
  }
  if (!std::isnan(time.hover_s)) {
    const float x = plot.x_px(time.hover_s - time.zero_s);
    plot.list().AddLine({x, plot.top()}, {x, plot.bottom()}, ink(style.colours().quiet));
  }
  return plot.hovered();
}

void draw_readings(const LivePlot& plot, const UiStyle& style, const CurveTime& time,
                   const std::vector<Reading>& readings) {
  if (!plot.hovered() || std::isnan(time.hover_s)) return;
  char heading[48];
  std::snprintf(heading, sizeof heading, "at %.3f s", time.hover_s - time.zero_s);
  const float line = ImGui::GetTextLineHeight();
  float width = ImGui::CalcTextSize(heading).x;
  for (const Reading& reading : readings) width = std::max(width, ImGui::CalcTextSize(reading.text.c_str()).x + line);
  const float pad = 0.4F * line;
  const float high = line * static_cast<float>(readings.size() + 1) + 2.0F * pad;
  const float mouse_px = plot.x_px(time.hover_s - time.zero_s);
  // The text is on the side with more room, so that it does not hide the curve under the mouse.
  const bool left = mouse_px > 0.5F * (plot.left() + plot.right());
  const float x = left ? mouse_px - width - 3.0F * pad : mouse_px + pad;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddRectFilled({x, plot.top()}, {x + width + 2.0F * pad, plot.top() + high}, ink(style.colours().panel, 0.92F),
                     4.0F);
  list.AddRect({x, plot.top()}, {x + width + 2.0F * pad, plot.top() + high}, ink(style.colours().grid), 4.0F);
  float y = plot.top() + pad;
  list.AddText({x + pad, y}, ink(style.colours().text), heading);
  for (const Reading& reading : readings) {
    y += line;
    list.AddRectFilled({x + pad, y + 0.3F * line}, {x + pad + 0.5F * line, y + 0.8F * line}, ink(reading.colour), 2.0F);
    list.AddText({x + pad + line, y}, ink(style.colours().text), reading.text.c_str());
  }
}

void draw_label(const LivePlot& plot, const CurveLabel& label) {
  const float line = ImGui::GetTextLineHeight();
  const float width = ImGui::CalcTextSize(label.text.c_str()).x;
  // The label is above the end of the curve, or below it if there is no room.
  const float y = label.y_px - 1.2F * line > plot.top() ? label.y_px - 1.2F * line : label.y_px + 0.2F * line;
  plot.list().AddText({plot.right() - width - 0.3F * line, y}, ink(label.colour), label.text.c_str());
}

}  // namespace palpate
