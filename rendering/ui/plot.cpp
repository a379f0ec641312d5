#include "rendering/ui/plot.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "engine/base/text.h"

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

bool LivePlot::owns_drag() const noexcept {
  const ImVec2 began = ImGui::GetIO().MouseClickedPos[ImGuiMouseButton_Left];
  return began.x >= left() && began.x <= right() && began.y >= top() && began.y <= bottom();
}

std::vector<double> LivePlot::ticks(const Range& range, int most) const {
  std::vector<double> values;
  if (axes_.decades) {
    std::vector<double> marks{1.0, 2.0, 5.0};
    if (range.to - range.from < 0.6) marks = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
    for (double decade = std::floor(range.from); decade <= range.to; decade += 1.0)
      for (const double mark : marks) values.push_back(decade + std::log10(mark));
    std::erase_if(values, [&](double value) { return value < range.from || value > range.to; });
    return values;
  }
  double step = tick_step(range.to - range.from, most);
  if (range.from == -range.to) step = std::min(step, range.to);  // 0 alone would be no scale
  const double first = std::ceil(range.from / step - 1e-9);
  for (double i = first; i * step <= range.to + 1e-9 * step; i += 1.0) values.push_back(i * step + 0.0);  // no -0
  return values;
}

std::string LivePlot::label(double value, const char* unit) const {
  return general(axes_.decades ? std::pow(10.0, value) : value, 7) + (*unit == '\0' ? "" : " ") + unit;
}

void LivePlot::draw_y_axis() const {
  const float line = ImGui::GetFontSize();
  const auto values = ticks(axes_.y, std::max(1, static_cast<int>((high_.y - low_.y) / (1.7F * line))));
  float below_px = high_.y + 2.0F * line;
  for (const double y : values) {
    const float at = y_px(y);
    list_->AddLine({low_.x, std::round(at)}, {high_.x, std::round(at)}, ink(style_.colours().grid));
    // A label without room is left out; those of whole decades come first.
    const bool beside_decade = axes_.decades && y != std::round(y) && std::abs(at - y_px(std::round(y))) < 1.1F * line;
    if (beside_decade || below_px - at < 1.1F * line) continue;
    below_px = at;
    const std::string text = label(y, y == values.back() ? axes_.y_unit : "");
    list_->AddText({low_.x - ImGui::CalcTextSize(text.c_str()).x - 0.3F * line, at - 0.55F * line},
                   ink(style_.colours().quiet), text.c_str());
  }
}

void LivePlot::draw_x_axis() const {
  const float line = ImGui::GetFontSize();
  auto values = ticks(axes_.x, std::max(1, static_cast<int>((high_.x - low_.x) / (4.0F * line))));
  std::ranges::reverse(values);  // from the right, because the last label has the unit
  float free_px = high_.x + 2.0F * line;
  const char* unit = axes_.x_unit;
  for (const double x : values) {
    list_->AddLine({std::round(x_px(x)), low_.y}, {std::round(x_px(x)), high_.y}, ink(style_.colours().grid));
    if (x < axes_.x_least) continue;
    const std::string text = label(x, unit);
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    const float at = std::clamp(x_px(x) - 0.5F * wide, low_.x - 1.5F * line, high_.x + 0.6F * line - wide);
    if (at + wide + 0.4F * line > free_px) continue;
    free_px = at;
    unit = "";
    list_->AddText({at, high_.y + 0.15F * line}, ink(style_.colours().quiet), text.c_str());
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
