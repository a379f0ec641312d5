#include "rendering/panels/time_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/text.h"

namespace palpate {

constexpr float kDrag_px = 6.0F;     // a shorter movement is a click
constexpr double kWheelShare = 0.1;  // one step of the wheel scrolls by this share of the visible span

double predicted_error_N(const HistoryPoint& tick) noexcept {
  if (!std::isnan(tick.reference_N)) return std::nan("");
  return tick.in_contact ? tick.predicted_error_N : 0.0;
}

void CurveColumns::gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s,
                          double to_s, std::size_t count) {
  const double width_s = (to_s - from_s) / static_cast<double>(count);
  const double first = std::floor(from_s / width_s);
  std::size_t next = 0;
  if (scroll(width_s, first, slots, count)) {
    next = history.first_at(std::nextafter(taken_s_, std::numeric_limits<double>::infinity()));
  } else {
    columns_.assign(count + 2, CurveColumn());
    next = history.first_at(first * width_s);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i)
    columns_[i].time_s = (first + static_cast<double>(i) + 0.5) * width_s;
  for (; next < history.size(); ++next) {
    const HistoryPoint& point = history[next];
    const double place = point.loop_time_s / width_s - first;
    if (place >= static_cast<double>(columns_.size())) break;
    if (place >= 0.0) add(point, jnd, columns_[static_cast<std::size_t>(place)]);
    taken_s_ = point.loop_time_s;
  }
  find_highest();
}

// Keeps the columns that remain in view. Returns false if there are none.
bool CurveColumns::scroll(double width_s, double first, std::size_t slots, std::size_t count) {
  const bool same = columns_.size() == count + 2 && slots == slots_ && std::abs(width_s - width_s_) < 1e-9 * width_s &&
                    first >= first_ && first - first_ < static_cast<double>(columns_.size());
  if (same) {
    const auto gone = static_cast<std::ptrdiff_t>(first - first_);
    std::move(columns_.begin() + gone, columns_.end(), columns_.begin());
    std::fill(columns_.end() - gone, columns_.end(), CurveColumn());
  } else {
    taken_s_ = -std::numeric_limits<double>::infinity();
  }
  slots_ = slots;
  width_s_ = width_s;
  first_ = first;
  return same;
}

void CurveColumns::add(const HistoryPoint& point, const JndLine& jnd, CurveColumn& column) {
  column.fault_level = std::max(column.fault_level, point.fault_level);
  const auto farthest = [&](const HistoryPoint& tick) {
    double most = -1.0;
    for (std::size_t i = 0; i < slots_; ++i) most = std::max(most, std::abs(tick.difference_over_jnd(i, jnd)));
    return most;
  };
  // The last of equal ticks; a comparison with NaN is false.
  if (!column.any || farthest(point) >= farthest(column.tick)) {
    column.tick = point;
    column.jnd_N = static_cast<float>(jnd.at(point.reference_N));
  }
  column.any = true;
  for (std::size_t i = 0; i < slots_; ++i) {
    const auto difference = static_cast<float>(point.difference_over_jnd(i, jnd));
    if (std::isnan(difference)) continue;
    // These ignore NaN.
    column.low_over_jnd[i] = std::fmin(column.low_over_jnd[i], difference);
    column.high_over_jnd[i] = std::fmax(column.high_over_jnd[i], difference);
  }
}

void CurveColumns::find_highest() {
  highest_force_N_ = 0.0F;
  for (const CurveColumn& column : columns_) {
    highest_force_N_ = std::fmax(highest_force_N_, column.tick.reference_N + column.jnd_N);
    for (std::size_t i = 0; i < slots_; ++i) highest_force_N_ = std::fmax(highest_force_N_, column.tick.force_N[i]);
  }
}

TimePlot::TimePlot(const UiStyle& style, const ImVec2& size, const Range& y, const char* y_unit, CurveTime& time,
                   double end_s, const CurveColumns& columns)
    : LivePlot(style, size, {{end_s - time.shown_s - time.zero_s, end_s - time.zero_s}, y, "s", y_unit, false, 0.0}),
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
      // Beyond the frame a curve runs along its edge.
      const auto inside_px = [this](double y) { return std::clamp(y_px(y), top() + 1.0F, bottom() - 1.0F); };
      runs.back().push_back({time_px(column.tick.loop_time_s), inside_px(values.from), inside_px(values.to)});
    }
  }
  return runs;
}

void TimePlot::curve(ImU32 colour, float thickness, const ColumnRange& range, const Dashes& dashes) const {
  std::vector<ImVec2> points;
  const float start_px = time_px(time_.zero_s);  // so that dashes move with the curve
  for (const std::vector<ColumnPixels>& run : runs(range)) {
    points.clear();
    for (const auto& [x, low, high] : run) {
      // The nearer end first, because a polyline that reverses its direction has no width there.
      const bool falling = !points.empty() && low - points.back().y > points.back().y - high;
      points.emplace_back(x, falling ? high : low);
      if (low - high > 1.5F) points.emplace_back(x, falling ? low : high);
    }
    line(points, colour, thickness, dashes, start_px);
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

// The plot in which a drag began owns it, also where the mouse leaves it.
void drag_time(CurveTime& time, const LivePlot& plot, double at_s, double end_s) {
  if (plot.hovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) time.dragging = !ImGui::GetIO().KeyShift;
  if (!time.dragging || !plot.owns_drag()) return;
  ImGui::IsMouseDown(ImGuiMouseButton_Left) ? time.drag_to(at_s, end_s) : time.end_drag();
}

void TimePlot::drag(double oldest_s) {
  drag_time(time_, *this, std::max(oldest_s, time_under_mouse()), end_s_);
  if (hovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && ImGui::GetIO().KeyShift)
    time_.zoom_from_s = time_under_mouse();
  if (std::isnan(time_.zoom_from_s) || !owns_drag()) return;
  const float from_px = time_px(time_.zoom_from_s), to_px = time_px(time_under_mouse());
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    list().AddRectFilled({std::min(from_px, to_px), top()}, {std::max(from_px, to_px), bottom()},
                         ink(style_.colours().text, 0.10F));
    return;
  }
  if (std::abs(to_px - from_px) > kDrag_px) time_.zoom(time_.zoom_from_s, time_under_mouse());
  time_.zoom_from_s = std::nan("");
}

bool TimePlot::handle_mouse(const ForceHistory& history) {
  const double oldest_s = history.size() > 0 ? history[0].loop_time_s : end_s_;
  drag(oldest_s);
  if (hovered()) {
    time_.hover_s = time_under_mouse();
    if (const float wheel = ImGui::GetIO().MouseWheel; wheel != 0.0F) {
      time_.pause(end_s_);
      time_.scroll_back(kWheelShare * time_.shown_s * wheel, oldest_s);
    }
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) time_.run();
  }
  const auto mark = [&](double at_s, float thickness) {
    if (std::isnan(at_s) || at_s > end_s_) return;
    const float x = time_px(at_s);
    list().AddLine({x, top()}, {x, bottom()}, ink(thickness > 1.0F ? style_.colours().text : style_.colours().quiet),
                   thickness);
  };
  mark(time_.hover_s, 1.0F);
  if (!std::isnan(time_.moment_s) || !std::isnan(time_.rest_s)) mark(time_.at_s(end_s_), 2.0F);
  return hovered();
}

void TimePlot::draw_readings(const std::vector<CurveReading>& readings) const {
  if (!hovered() || readings.empty()) return;
  const std::string heading = "at " + fixed(time_.hover_s - time_.zero_s, 3) + " s";
  const float line = ImGui::GetTextLineHeight();
  float width = ImGui::CalcTextSize(heading.c_str()).x;
  for (const CurveReading& reading : readings)
    width = std::max(width, ImGui::CalcTextSize(reading.text.c_str()).x + line);
  const float pad = 0.4F * line;
  const float mouse_px = time_px(time_.hover_s);
  const ImVec2 size(width + 2.0F * pad, line * static_cast<float>(readings.size() + 1) + 2.0F * pad);
  // The text is on the side with more room, so that it does not hide the curve under the mouse; beside the panel where
  // it would hide other plots.
  const bool at_left = mouse_px > 0.5F * (left() + right());
  const ImVec2 low(size.y > bottom() - top() + line ? std::max(0.0F, ImGui::GetWindowPos().x - size.x)
                   : at_left                        ? mouse_px - size.x - pad
                                                    : mouse_px + pad,
                   top());
  const ImVec2 high(low.x + size.x, low.y + size.y);
  ImDrawList& front = *ImGui::GetForegroundDrawList();
  front.AddRectFilled(low, high, ink(style_.colours().panel, 0.92F), 4.0F);
  front.AddRect(low, high, ink(style_.colours().grid), 4.0F);
  float y = low.y + pad;
  front.AddText({low.x + pad, y}, ink(style_.colours().text), heading.c_str());
  for (const CurveReading& reading : readings) {
    y += line;
    front.AddRectFilled({low.x + pad, y + 0.3F * line}, {low.x + pad + 0.5F * line, y + 0.8F * line},
                        ink(reading.colour), 2.0F);
    front.AddText({low.x + pad + line, y}, ink(style_.colours().text), reading.text.c_str());
  }
}

}  // namespace palpate
