#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "rendering/panels/panel.h"

namespace palpate {
namespace {

constexpr double kBudget_ns = 1e6;
// The shortest ranges, so that equal models do not seem to differ.
constexpr double kLeastTime = 0.3, kLeastError = 0.5;
constexpr double kMargin = 0.08;          // of a range, at each end
constexpr double kNameMargin = 0.2;       // the same at the side of the names, and above the JND for its caption
constexpr double kSmallestError = 0.003;  // far below what can be drawn beside 1

// The upper end of the spread of the time as far as it is drawn; other programs may prolong a round at will.
double drawn_high_ns(const Timing& tick) { return std::min(tick.high_ns, 1.2 * tick.median_ns); }
double log_error(double error_over_jnd) { return std::log10(std::max(error_over_jnd, kSmallestError)); }

bool has_dot(const ModelsView& models, std::size_t slot) {
  const ModelView& one = models.slots[slot];
  return one.state == SlotState::ready && one.errors.samples > 0 && one.tick_ns() > 0.0 && slot != models.reference;
}

struct Extent {
  double from = 1e9, to = -1e9;
  void add(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
  Range range(double least, double upper_margin) const {
    const double widen = std::max(0.0, 0.5 * (least - (to - from)));
    const double low = from - widen, high = to + widen;
    return {low - kMargin * (high - low), high + upper_margin * (high - low)};
  }
};

// The gridlines of 2 and 5 times a power of ten; in less than half a decade, of 3 and 7 as well.
std::vector<double> between_decades(const Range& range) {
  std::vector<double> marks{2.0, 5.0};
  if (range.to - range.from < 0.6) marks = {1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  std::vector<double> values;
  for (double decade = std::floor(range.from); decade <= range.to; decade += 1.0) {
    for (const double mark : marks) {
      const double at = decade + std::log10(mark);
      if (at > range.from && at < range.to) values.push_back(at);
    }
  }
  return values;
}

struct SpeedPlot {
  const ModelsView& models;
  const UiStyle& style;
  const LivePlot& plot;
  const PlotAxes& axes;
  std::vector<ImVec4> placed{}, lines{};  // rectangles of dots and names; of lines

  float line() const { return ImGui::GetFontSize(); }
  ImDrawList& list() const { return plot.list(); }
  ImU32 colour(std::size_t slot, float alpha = 1.0F) const {
    return ink(slot_colour(models, slot, style.theme()), alpha);
  }
  ImVec2 at(double time_ns, double error_over_jnd) const {
    return {plot.x_px(std::log10(time_ns)), plot.y_px(log_error(error_over_jnd))};
  }

  // Axes have labels at decades only; draws lines and labels between them. The labels are outside of the frame.
  void draw_grid() const {
    const ImU32 grid = ink(style.colours().grid), quiet = ink(style.colours().quiet);
    for (const double time : between_decades(axes.x))
      list().AddLine({plot.x_px(time), plot.top()}, {plot.x_px(time), plot.bottom()}, grid);
    for (const double error : between_decades(axes.y)) plot.level(error, grid, 1.0F);
    list().PushClipRectFullScreen();
    float free_px = plot.left() - line();
    for (const double time : between_decades(axes.x)) {
      const std::string text = fixed(std::pow(10.0, time), 0);
      const float width = ImGui::CalcTextSize(text.c_str()).x, x = plot.x_px(time) - 0.5F * width;
      if (x < free_px || x + width > plot.right() - 2.0F * line()) continue;
      list().AddText({x, plot.bottom() + 0.15F * line()}, quiet, text.c_str());
      free_px = x + width + 0.6F * line();
    }
    float above_px = plot.bottom() + line();
    for (const double error : between_decades(axes.y)) {
      const std::string text = general(std::pow(10.0, error), 2);
      const float y = plot.y_px(error);
      if (above_px - y < 1.1F * line() || std::abs(y - plot.y_px(0.0)) < 1.1F * line()) continue;
      list().AddText({plot.left() - ImGui::CalcTextSize(text.c_str()).x - 0.3F * line(), y - 0.55F * line()}, quiet,
                     text.c_str());
      above_px = y;
    }
    list().PopClipRect();
  }

  // Draws the intervals, the path over the number of centres, and the dot of a model.
  void draw_dot(std::size_t slot) {
    const ModelView& one = models.slots[slot];
    const float size = style.scale();
    const ImVec2 dot = at(one.tick_ns(), one.errors.p99_error_over_jnd);
    std::vector<ImVec2> path;
    for (const auto& [centres, point] : one.path) {
      path.push_back(at(point.first, point.second));
      list().AddCircleFilled(path.back(), 2.0F * size, colour(slot, 0.6F));
    }
    plot.line(path, colour(slot, 0.6F), size);
    for (const auto& [centres, figures] : one.path) {
      const bool is_end = centres == one.path.begin()->first || centres == one.path.rbegin()->first;
      if (!is_end || centres == one.centres) continue;
      const ImVec2 by = at(figures.first, figures.second);
      list().AddText({by.x + 3.0F * size, by.y - line()}, ink(style.colours().quiet), std::to_string(centres).c_str());
    }
    if (one.p99_interval.known()) {
      list().AddLine({dot.x, plot.y_px(log_error(one.p99_interval.low))},
                     {dot.x, plot.y_px(log_error(one.p99_interval.high))}, colour(slot), 1.5F * size);
    }
    const ImVec2 low = at(one.tick.low_ns, one.errors.p99_error_over_jnd);
    const ImVec2 high = at(drawn_high_ns(one.tick), one.errors.p99_error_over_jnd);
    list().AddLine(low, high, colour(slot), 1.5F * size);
    const float radius = (slot == models.verdict.chosen ? 7.0F : 5.0F) * size;
    draw_mark(list(), dot, radius, one.paper, colour(slot), style);
    placed.push_back({dot.x - radius, dot.y - radius, dot.x + radius, dot.y + radius});
    lines.push_back({low.x, dot.y - 1.0F, high.x, dot.y + 1.0F});
  }

  bool is_free(const ImVec4& box, bool over_lines = false) const {
    if (box.x < plot.left() || box.z > plot.right() || box.y < plot.top() || box.w > plot.bottom()) return false;
    const auto covers = [&](const ImVec4& other) {
      return box.x < other.z && other.x < box.z && box.y < other.w && other.y < box.w;
    };
    return std::ranges::none_of(placed, covers) && (over_lines || std::ranges::none_of(lines, covers));
  }

  // Draws what the JND is above its line, at the left or the right, where no model is.
  void draw_caption() {
    const char* text = "above 1: most people notice it";
    const float width = ImGui::CalcTextSize(text).x, gap = 0.4F * line(), bottom = plot.y_px(0.0);
    ImVec4 box(plot.left() + gap, bottom - 1.1F * line(), plot.left() + gap + width, bottom);
    const ImVec4 right(plot.right() - gap - width, box.y, plot.right() - gap, box.w);
    if (!is_free(box) && is_free(right)) box = right;
    placed.push_back(box);
    list().AddText({box.x, box.y}, ink(style.colours().quiet), text);
  }

  // Draws the name beside, above or below its dot where it is free, if need be over lines; far from the dot, joined to
  // it by a line.
  void draw_name(std::size_t slot) {
    const ModelView& one = models.slots[slot];
    const ImVec2 dot = at(one.tick_ns(), one.errors.p99_error_over_jnd);
    const ImVec2 size = ImGui::CalcTextSize(one.name.c_str());
    // Beyond the ends of the spread of the time.
    const float gap = 0.6F * line();
    const float right = std::max(dot.x, plot.x_px(std::log10(drawn_high_ns(one.tick))) - 0.3F * line()) + gap;
    const float left_end = std::min(dot.x, plot.x_px(std::log10(one.tick.low_ns)) + 0.3F * line()) - gap;
    constexpr int kPlaces = 27;
    const auto box_of = [&](int step) {
      const int row = step / 3;
      const float shift = static_cast<float>((row + 1) / 2) * (row % 2 == 0 ? 0.7F : -0.7F) * size.y;
      const float left = step % 3 == 0 ? right : step % 3 == 1 ? left_end - size.x : dot.x - 0.5F * size.x;
      const float top = dot.y - 0.5F * size.y + shift;
      return ImVec4(left, top, left + size.x, top + size.y);
    };
    int step = 0;
    while (step < 2 * kPlaces && !is_free(box_of(step % kPlaces), step >= kPlaces)) ++step;
    const ImVec4 box = box_of(step % kPlaces);
    placed.push_back(box);
    const float edge = box.x > dot.x ? box.x : box.z, middle = 0.5F * (box.y + box.w);
    const bool beside = box.x > dot.x || box.z < dot.x;
    if (beside && std::abs(middle - dot.y) > 0.5F * size.y) list().AddLine(dot, {edge, middle}, colour(slot, 0.5F));
    list().AddText({box.x, box.y}, ink(text_colour(slot_colour(models, slot, style.theme()), style.theme())),
                   one.name.c_str());
  }
};

void draw_budget(const ModelView& one, const ImU32 colour, const UiStyle& style) {
  const std::string text = fixed(one.tick_ns(), 0) + " ns = " + tick_share(one.tick_ns()) + " of 1 ms";
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight(), all = ImGui::GetContentRegionAvail().x;
  const float left = at.x + 2.6F * ImGui::GetFontSize();
  const float right = at.x + all - ImGui::CalcTextSize(text.c_str()).x - line;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({left, at.y + 0.3F * line}, {right, at.y + 0.7F * line}, ink(style.colours().band));
  list.AddRect({left, at.y + 0.3F * line}, {right, at.y + 0.7F * line}, ink(style.colours().edge));
  const float used = std::max(1.5F, (right - left) * static_cast<float>(one.tick_ns() / kBudget_ns));
  list.AddRectFilled({left, at.y + 0.2F * line}, {left + used, at.y + 0.8F * line}, colour);
  list.AddText({right + 0.5F * line, at.y}, ink(style.colours().quiet), text.c_str());
  ImGui::Dummy({all, line});
  tip("The bar is the 1 ms of a tick; the mark at its left is the time that this model takes of it.");
}

}  // namespace

PlotAxes speed_axes(const ModelsView& models) {
  Extent time, error;
  error.add(0.0);  // the JND
  for (const std::size_t slot : models.listed()) {
    if (!has_dot(models, slot)) continue;
    const ModelView& one = models.slots[slot];
    for (const double ns : {one.tick.low_ns, drawn_high_ns(one.tick)}) time.add(std::log10(ns));
    error.add(log_error(one.errors.p99_error_over_jnd));
    if (one.p99_interval.known()) {
      error.add(log_error(one.p99_interval.low));
      error.add(log_error(one.p99_interval.high));
    }
    for (const auto& [centres, point] : one.path) {
      time.add(std::log10(point.first));
      error.add(log_error(point.second));
    }
  }
  PlotAxes axes{{2.0, 3.0}, {-1.0, 1.0}, "ns", "", true};
  if (time.from > time.to) return axes;
  axes.x = time.range(kLeastTime, kNameMargin);
  axes.y = error.range(kLeastError, kNameMargin);
  return axes;
}

void draw_speed(const ModelsView& models, const UiStyle& style, float height) {
  const PlotAxes axes = speed_axes(models);
  const float budget = ImGui::GetTextLineHeightWithSpacing();
  {
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height - budget}, axes);
    plot.jnd_band(axes.y.from, 0.0);
    SpeedPlot drawing{models, style, plot, axes};
    drawing.draw_grid();
    plot.level(0.0, ink(style.colours().text), 1.5F * style.scale());
    std::vector<std::size_t> dots = models.drawn();
    std::erase_if(dots, [&](std::size_t slot) { return !has_dot(models, slot); });
    for (const std::size_t slot : dots) drawing.draw_dot(slot);
    drawing.draw_caption();
    const float jnd_px = plot.y_px(0.0);
    drawing.lines.push_back({plot.left(), jnd_px - 1.0F, plot.right(), jnd_px + 1.0F});
    std::ranges::sort(dots, {}, [&](std::size_t slot) { return models.slots[slot].errors.p99_error_over_jnd; });
    for (const std::size_t slot : dots) drawing.draw_name(slot);
  }
  tip("For each model: the time of a whole tick, and the error that 99 % of the samples do not exceed.\n"
      "Left and low is better. Filled: this program's; hollow: as in the paper of 2009. Lines: 95 % interval of the\n"
      "error, spread of the time. The thin line is the path over the numbers of centres that were tried.\n"
      "Both values are columns of the table.");
  const std::size_t named = models.verdict.chosen.value_or(models.selected);
  if (named < models.slots.size() && has_dot(models, named))
    draw_budget(models.slots[named], ink(slot_colour(models, named, style.theme())), style);
}

}  // namespace palpate
