#include <algorithm>
#include <cmath>

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

struct SpeedPlot {
  const ModelsView& models;
  const UiStyle& style;
  const LivePlot& plot;
  std::vector<ImVec4> placed{}, lines{};  // rectangles of dots and names; of lines

  float line() const { return ImGui::GetFontSize(); }
  ImDrawList& list() const { return plot.list(); }
  ImU32 colour(std::size_t slot, float alpha = 1.0F) const {
    return ink(slot_colour(models, slot, style.theme()), alpha);
  }
  ImVec2 at(double time_ns, double error_over_jnd) const {
    return {plot.x_px(std::log10(time_ns)), plot.y_px(log_error(error_over_jnd))};
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

  // Draws what the JND is above its line, where no model is.
  void draw_caption() {
    const char* text = "above 1: most notice it";
    const float width = ImGui::CalcTextSize(text).x, bottom = plot.y_px(0.0), step = 1.5F * line();
    for (float left = plot.left() + 0.4F * line(); left + width < plot.right(); left += step) {
      const ImVec4 box(left, bottom - 1.1F * line(), left + width, bottom);
      if (!is_free(box)) continue;
      placed.push_back(box);
      return list().AddText({box.x, box.y}, ink(style.colours().quiet), text);
    }
  }

  // Draws the name beside, above or below its dot where it is free, if need be over lines; far from the dot, joined to
  // it by a line; not at all where there is no room.
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
    if (step == 2 * kPlaces) return;
    const ImVec4 box = box_of(step % kPlaces);
    placed.push_back(box);
    const float edge = box.x > dot.x ? box.x : box.z, middle = 0.5F * (box.y + box.w);
    const bool beside = box.x > dot.x || box.z < dot.x;
    if (beside && std::abs(middle - dot.y) > 0.5F * size.y) list().AddLine(dot, {edge, middle}, colour(slot, 0.5F));
    list().AddText({box.x, box.y}, ink(text_colour(slot_colour(models, slot, style.theme()), style.theme())),
                   one.name.c_str());
  }
};

void draw_budget(const ModelView& one, const Rgb& colour, const ImVec2& size) {
  const std::string text = fixed(one.tick_ns(), 0) + " ns = " + tick_share(one.tick_ns()) + " of 1 ms";
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, paint(colour));
  ImGui::ProgressBar(static_cast<float>(one.tick_ns() / kBudget_ns), size, text.c_str());
  ImGui::PopStyleColor();
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

void draw_against_force(const ModelsView& models, const UiStyle& style, const ImVec2& size) {
  constexpr std::uint64_t kFewest = 20;  // samples of a bin with a useful deviation
  const auto value = [](const ForceBin& bin) { return bin.over_jnd.mean() + bin.over_jnd.deviation(); };
  double force_N = 1.0, most = 1.2;
  for (const std::size_t slot : models.drawn()) {
    for (const ForceBin& bin : models.slots[slot].errors.bins) {
      if (bin.over_jnd.count() < kFewest) continue;
      force_N = std::max(force_N, bin.force_to_N);
      most = std::max(most, value(bin));
    }
  }
  const LivePlot plot(style, size, {{0.0, force_N}, {0.0, round_up(most)}, "N", ""});
  plot.jnd_band(0.0, 1.0);
  for (const std::size_t slot : models.drawn()) {
    std::vector<ImVec2> points;
    for (const ForceBin& bin : models.slots[slot].errors.bins)
      if (bin.over_jnd.count() >= kFewest)
        points.emplace_back(plot.x_px(0.5 * (bin.force_from_N + bin.force_to_N)), plot.y_px(value(bin)));
    plot.line(points, ink(slot_colour(models, slot, style.theme())),
              (slot == models.selected ? 2.0F : 1.4F) * style.scale(), slot_dashes(models, slot));
  }
}

void draw_speed(const ModelsView& models, const UiStyle& style, const ImVec2& size) {
  const PlotAxes axes = speed_axes(models);
  // The bar has a frame around the text, because it cuts the text at its frame.
  const float bar = ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().FrameBorderSize;
  {
    const LivePlot plot(style, {size.x, size.y - bar - ImGui::GetStyle().ItemSpacing.y}, axes);
    plot.jnd_band(axes.y.from, 0.0);
    SpeedPlot drawing{models, style, plot};
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
    draw_budget(models.slots[named], slot_colour(models, named, style.theme()), {size.x, bar});
}

}  // namespace palpate
