#include "rendering/ui/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace palpate {

double tick_step(double span, int most) noexcept {
  if (!(span > 0.0) || most < 1) return 1.0;
  const double rough = span / most;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= rough * (1.0 - 1e-9)) return step * decade;
  }
  return 10.0 * decade;
}

double round_up(double value) noexcept {
  if (!(value > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (step * decade >= value * (1.0 - 1e-9)) return step * decade;
  }
  return 10.0 * decade;
}

Plot::Plot(const UiStyle& style, const ImVec2& size, const Range& x, const Range& y, const char* x_unit,
           const char* y_unit, bool x_numbers)
    : style_(style), list_(ImGui::GetWindowDrawList()), x_(x), y_(y) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetFontSize();
  low_ = {at.x + 2.6F * line, at.y + 0.45F * line};
  high_ = {at.x + size.x - 0.6F * line, at.y + size.y - (x_numbers ? 1.35F : 0.45F) * line};
  ImGui::Dummy(size);
  draw_axes(x_unit, y_unit, x_numbers);
  list_->PushClipRect(low_, high_, true);
}

Plot::~Plot() { list_->PopClipRect(); }

float Plot::x_px(double x) const noexcept {
  return low_.x + static_cast<float>((x - x_.from) / (x_.to - x_.from)) * (high_.x - low_.x);
}

float Plot::y_px(double y) const noexcept {
  return high_.y - static_cast<float>((y - y_.from) / (y_.to - y_.from)) * (high_.y - low_.y);
}

bool Plot::hovered() const noexcept { return ImGui::IsMouseHoveringRect(low_, high_); }

void Plot::draw_axes(const char* x_unit, const char* y_unit, bool x_numbers) const {
  const Palette& p = style_.colours();
  const float line = ImGui::GetFontSize();
  const ImU32 grid = ink(p.grid);
  const ImU32 words = ink(p.quiet);
  char text[48];
  const int rows = std::max(1, static_cast<int>((high_.y - low_.y) / (1.7F * line)));
  const double y_step = tick_step(y_.to - y_.from, rows);
  for (double y = std::ceil(y_.from / y_step - 1e-9) * y_step; y <= y_.to + 1e-9 * y_step; y += y_step) {
    list_->AddLine({low_.x, std::round(y_px(y))}, {high_.x, std::round(y_px(y))}, grid);
    const bool last = y + y_step > y_.to + 1e-9 * y_step;
    std::snprintf(text, sizeof text, "%g%s%s", std::abs(y) < 1e-9 ? 0.0 : y,
                  last && *y_unit != '\0' ? " " : "", last ? y_unit : "");
    const ImVec2 size = ImGui::CalcTextSize(text);
    list_->AddText({low_.x - size.x - 0.3F * line, y_px(y) - 0.55F * line}, words, text);
  }
  const double x_step = tick_step(x_.to - x_.from, std::max(1, static_cast<int>(width() / (4.0F * line))));
  for (double x = std::ceil(x_.from / x_step - 1e-9) * x_step; x <= x_.to + 1e-9 * x_step; x += x_step) {
    list_->AddLine({std::round(x_px(x)), low_.y}, {std::round(x_px(x)), high_.y}, grid);
    if (!x_numbers) continue;
    const bool last = x + x_step > x_.to + 1e-9 * x_step;
    std::snprintf(text, sizeof text, "%g%s%s", std::abs(x) < 1e-9 ? 0.0 : x, last ? " " : "",
                  last ? x_unit : "");
    const ImVec2 size = ImGui::CalcTextSize(text);
    const float at = std::min(x_px(x) - 0.5F * size.x, high_.x + 0.6F * line - size.x);
    list_->AddText({at, high_.y + 0.15F * line}, words, text);
  }
}

void Plot::line(const std::vector<ImVec2>& points, ImU32 colour, float thickness) const {
  if (points.size() > 1)
    list_->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, thickness);
}

void Plot::band(const std::vector<ImVec2>& upper, const std::vector<ImVec2>& lower, ImU32 colour) const {
  if (upper.size() < 2 || upper.size() != lower.size()) return;
  const int quads = static_cast<int>(upper.size()) - 1;
  list_->PrimReserve(6 * quads, 2 * static_cast<int>(upper.size()));
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const auto first = static_cast<ImDrawIdx>(list_->_VtxCurrentIdx);
  for (std::size_t i = 0; i < upper.size(); ++i) {
    list_->PrimWriteVtx(upper[i], white, colour);
    list_->PrimWriteVtx(lower[i], white, colour);
  }
  for (int i = 0; i < quads; ++i) {
    for (const int corner : {0, 1, 2, 2, 1, 3})
      list_->PrimWriteIdx(static_cast<ImDrawIdx>(first + 2 * i + corner));
  }
}

void Plot::level(double y, ImU32 colour, float thickness) const {
  list_->AddLine({low_.x, y_px(y)}, {high_.x, y_px(y)}, colour, thickness);
}

void Plot::caption(const std::string& text, float x, float y, ImU32 colour) const {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 room(high_.x - low_.x - size.x, high_.y - low_.y - size.y);
  list_->AddText({low_.x + x * room.x, low_.y + y * room.y}, colour, text.c_str());
}

}  // namespace palpate
