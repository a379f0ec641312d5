#include "rendering/ui/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

namespace palpate {

namespace {

// The smallest of these steps, or of 10, times a power of ten that is not below `value`; 1 for values <= 0.
double next_of(std::initializer_list<double> steps, double value) noexcept {
  if (!(value > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : steps)
    if (step * decade >= value * (1.0 - 1e-9)) return step * decade;
  return 10.0 * decade;
}

}  // namespace

double tick_step(double span, int most) noexcept { return most < 1 ? 1.0 : next_of({1.0, 2.0, 5.0}, span / most); }

double round_up(double value) noexcept { return next_of({1.0, 1.2, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}, value); }

std::vector<ImVec2> simplified(const std::vector<ImVec2>& points) {
  constexpr float kNear_px = 0.35F;
  constexpr std::size_t kMost = 32;  // points that one line replaces
  std::vector<ImVec2> kept;
  const auto is_near = [&](std::size_t from, std::size_t to) {
    const ImVec2 along(points[to].x - points[from].x, points[to].y - points[from].y);
    const float length = std::hypot(along.x, along.y);
    for (std::size_t i = from + 1; i < to; ++i) {
      const ImVec2 off(points[i].x - points[from].x, points[i].y - points[from].y);
      const float onward = off.x * along.x + off.y * along.y;
      if (onward < 0.0F || onward > length * length) return false;
      if (std::abs(off.x * along.y - off.y * along.x) > kNear_px * length) return false;
    }
    return true;
  };
  for (std::size_t i = 0, from = 0; i < points.size(); ++i) {
    if (i == 0 || i + 1 == points.size() || i + 1 - from > kMost || !is_near(from, i + 1)) {
      kept.push_back(points[i]);
      from = i;
    }
  }
  return kept;
}

LivePlot::LivePlot(const UiStyle& style, const ImVec2& size, const PlotAxes& axes)
    : style_(style), list_(ImGui::GetWindowDrawList()), axes_(axes) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetFontSize();
  low_ = {at.x + 2.6F * line, at.y + 0.45F * line};
  high_ = {at.x + size.x - 0.6F * line, at.y + size.y - 1.35F * line};
  ImGui::Dummy(size);
  draw_y_axis();
  draw_x_axis();
  list_->PushClipRect(low_, high_, true);
}

LivePlot::~LivePlot() { list_->PopClipRect(); }

float LivePlot::x_px(double x) const noexcept {
  return low_.x + static_cast<float>((x - axes_.x.from) / (axes_.x.to - axes_.x.from)) * (high_.x - low_.x);
}

float LivePlot::y_px(double y) const noexcept {
  return high_.y - static_cast<float>((y - axes_.y.from) / (axes_.y.to - axes_.y.from)) * (high_.y - low_.y);
}

double LivePlot::x_at(float px) const noexcept {
  return axes_.x.from + (px - low_.x) / (high_.x - low_.x) * (axes_.x.to - axes_.x.from);
}

bool LivePlot::hovered() const noexcept { return ImGui::IsMouseHoveringRect(low_, high_) && ImGui::IsWindowHovered(); }

double LivePlot::shown(double value) const noexcept {
  if (axes_.decades) return std::pow(10.0, std::round(value));
  return std::abs(value) < 1e-9 ? 0.0 : value;
}

void LivePlot::draw_y_axis() const {
  const Range& y_range = axes_.y;
  const float line = ImGui::GetFontSize();
  char text[48];
  const int rows = std::max(1, static_cast<int>((high_.y - low_.y) / (1.7F * line)));
  const double y_step = axes_.decades ? 1.0 : tick_step(y_range.to - y_range.from, rows);
  for (double y = std::ceil(y_range.from / y_step - 1e-9) * y_step; y <= y_range.to + 1e-9 * y_step; y += y_step) {
    list_->AddLine({low_.x, std::round(y_px(y))}, {high_.x, std::round(y_px(y))}, ink(style_.colours().grid));
    const bool last = y + y_step > y_range.to + 1e-9 * y_step;
    std::snprintf(text, sizeof text, "%g%s%s", shown(y), last && *axes_.y_unit != '\0' ? " " : "",
                  last ? axes_.y_unit : "");
    const ImVec2 size = ImGui::CalcTextSize(text);
    list_->AddText({low_.x - size.x - 0.3F * line, y_px(y) - 0.55F * line}, ink(style_.colours().quiet), text);
  }
}

void LivePlot::draw_x_axis() const {
  const Range& x_range = axes_.x;
  const float line = ImGui::GetFontSize();
  char text[48];
  const int columns = std::max(1, static_cast<int>(width() / (4.0F * line)));
  const double x_step = axes_.decades ? 1.0 : tick_step(x_range.to - x_range.from, columns);
  // From the right, because the last label has the unit. A label without room is left out.
  const double first = std::ceil(x_range.from / x_step - 1e-9) * x_step;
  const double steps = std::floor((x_range.to - first) / x_step + 1e-9);
  float free_px = high_.x + 2.0F * line;
  bool unit_follows = true;
  for (double i = steps; i >= 0.0; i -= 1.0) {
    const double x = first + i * x_step;
    list_->AddLine({std::round(x_px(x)), low_.y}, {std::round(x_px(x)), high_.y}, ink(style_.colours().grid));
    if (x < axes_.x_least) continue;
    std::snprintf(text, sizeof text, "%.7g%s%s", shown(x), unit_follows ? " " : "", unit_follows ? axes_.x_unit : "");
    const ImVec2 size = ImGui::CalcTextSize(text);
    const float at = std::clamp(x_px(x) - 0.5F * size.x, low_.x - 1.5F * line, high_.x + 0.6F * line - size.x);
    if (at + size.x + 0.4F * line > free_px) continue;
    free_px = at;
    unit_follows = false;
    list_->AddText({at, high_.y + 0.15F * line}, ink(style_.colours().quiet), text);
  }
}

void LivePlot::line(const std::vector<ImVec2>& all, ImU32 colour, float thickness, const Dashes& dashes,
                    float start_px) const {
  const std::vector<ImVec2> points = simplified(all);
  // For a whole thickness ImGui draws one textured strip, else three strips.
  const float whole = std::max(1.0F, std::round(thickness));
  if (points.size() > 1 && dashes.gap > 0.0F) return dashed(points, colour, whole, dashes, start_px);
  if (points.size() > 1) list_->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, whole);
}

// Cuts the line at the x where dashes begin and end. A steep piece is drawn as a whole, so that a peak is no dot.
void LivePlot::dashed(const std::vector<ImVec2>& points, ImU32 colour, float thickness, const Dashes& dashes,
                      float start_px) const {
  const float period = dashes.dash + dashes.gap;
  std::vector<ImVec2> piece;
  const auto flush = [&] {
    if (piece.size() > 1) list_->AddPolyline(piece.data(), static_cast<int>(piece.size()), colour, 0, thickness);
    piece.clear();
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const ImVec2 to = points[i + 1];
    for (ImVec2 at = points[i];;) {
      const float phase = at.x - start_px - period * std::floor((at.x - start_px) / period);
      const bool in_dash = phase < dashes.dash, drawn = in_dash || std::abs(to.y - at.y) > 4.0F * (to.x - at.x);
      // A little beyond the border, so that every step gets on.
      const float border = at.x + (in_dash ? dashes.dash : period) - phase + 0.01F;
      const bool last = border >= to.x;
      const float share = last ? 1.0F : (border - at.x) / (to.x - at.x);
      const ImVec2 next = last ? to : ImVec2(border, at.y + share * (to.y - at.y));
      if (drawn && piece.empty()) piece.push_back(at);
      if (drawn) piece.push_back(next);
      if (!drawn) flush();
      if (last) break;
      if (drawn) flush();
      at = next;
    }
  }
  flush();
}

void LivePlot::band(const std::vector<ImVec2>& upper, const std::vector<ImVec2>& lower, ImU32 colour) const {
  if (upper.size() < 2 || upper.size() != lower.size()) return;
  const int quads = static_cast<int>(upper.size()) - 1;
  list_->PrimReserve(6 * quads, 2 * static_cast<int>(upper.size()));
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const auto first = static_cast<ImDrawIdx>(list_->_VtxCurrentIdx);
  for (std::size_t i = 0; i < upper.size(); ++i) {
    list_->PrimWriteVtx(upper[i], white, colour);
    list_->PrimWriteVtx(lower[i], white, colour);
  }
  for (int i = 0; i < quads; ++i)
    for (const int corner : {0, 1, 2, 2, 1, 3}) list_->PrimWriteIdx(static_cast<ImDrawIdx>(first + 2 * i + corner));
}

void LivePlot::jnd_band(double from, double to) const {
  const Palette& p = style_.colours();
  list_->AddRectFilled({low_.x, y_px(to)}, {high_.x, y_px(from)}, ink(p.band));
  for (const double edge : {from, to}) level(edge, ink(p.edge), 1.0F);
}

void LivePlot::level(double y, ImU32 colour, float thickness) const {
  list_->AddLine({low_.x, y_px(y)}, {high_.x, y_px(y)}, colour, thickness);
}

}  // namespace palpate
