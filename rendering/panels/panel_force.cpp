#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "rendering/panels/curve_drawing.h"
#include "rendering/panels/panel_force.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/time_plot.h"

namespace palpate {
namespace {

constexpr float kReferenceLine_px = 2.4F;
constexpr float kModelLine_px = 1.4F;
constexpr float kSelectedLine_px = 2.0F;
// Width of a column in a window of 1080 lines; a finer one is hardly visible and costs time.
constexpr float kColumn_px = 2.6F;
// Range of the difference view on both sides of 0: three times the height of the band.
constexpr double kDifference_jnd = 3.0;
constexpr float kPredictedAlpha = 0.28F;
// Share of the width for the curves over time; the loops have the rest.
constexpr float kTimeShare = 0.6F;
// The most points of the loops: every few ticks of ten seconds.
constexpr std::size_t kLoopPoints = 1500;

// Moves the scale of an axis towards a round number above `wanted`. It decreases only if it is more than twice as
// large: an axis that moves is hard to read.
double eased_scale(double scale, double wanted) {
  const double target = round_up(wanted);
  if (target > scale) return scale + 0.25 * (target - scale);
  return scale > 2.0 * target ? scale + 0.05 * (target - scale) : scale;
}

}  // namespace

struct ForceCurves::Drawing {
  const WindowView& shown;
  ViewState& view;
  const UiStyle& style;
  double end_s = 0.0;

  Rgb colour(std::size_t slot) const { return slot_colour(shown.models, slot, style.theme()); }
  // Without a reference, the curves show the predicted error of the active model.
  bool predicts() const { return !shown.models.compared && shown.models.active() != nullptr; }
  template <typename Low, typename High>
  void paint_prediction(const CurvePainter& paint_on, Low low, High high) const {
    if (predicts()) paint_on.band(ink(colour(shown.models.selected), kPredictedAlpha), low, high);
  }
  // Visits the models in the order of drawing: the active one is the last, on top.
  template <typename Draw>
  void for_each_slot(Draw draw) const {
    const ModelsView& models = shown.models;
    for (std::size_t i = 0; i < models.slots.size(); ++i) {
      if (i != models.selected && models.slots[i].state == SlotState::ready) draw(i);
    }
    if (models.active() != nullptr) draw(models.selected);
  }
  template <typename Low, typename High>
  void paint_slot(const CurvePainter& paint_on, std::size_t slot, Low low, High high) const {
    const bool selected = slot == shown.models.selected;
    paint_on.curve(ink(colour(slot)), (selected ? kSelectedLine_px : kModelLine_px) * style.scale(), low, high);
  }
  template <typename Value>
  void paint_slot(const CurvePainter& paint_on, std::size_t slot, Value value) const {
    paint_slot(paint_on, slot, value, value);
  }
  PlotAxes axes(const Range& y, const char* unit, bool x_numbers) const {
    return {{end_s - view.time.shown_s - view.time.zero_s, end_s - view.time.zero_s}, y, "s", unit, x_numbers};
  }
};

void ForceCurves::draw(const WindowView& shown, ViewState& view, const UiStyle& style, float force_height,
                       float error_height) {
  const Drawing drawing = begin(shown, view, style);
  const float all = ImGui::GetContentRegionAvail().x;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  draw_titles_of_force(drawing, kTimeShare * all);
  draw_force(drawing, {kTimeShare * all - gap, force_height});
  ImGui::SameLine();
  draw_loops(drawing, {(1.0F - kTimeShare) * all, force_height});
  draw_titles_of_error(drawing);
  if (view.settings.difference) {
    draw_difference(drawing, error_height);
  } else {
    draw_sustained(drawing, error_height);
  }
  if (!hovered_) view.time.hover_s = std::nan("");
}

ForceCurves::Drawing ForceCurves::begin(const WindowView& shown, ViewState& view, const UiStyle& style) {
  hovered_ = false;
  const Drawing drawing{shown, view, style, view.time.end_s(steady_now_s())};
  const auto columns =
      static_cast<std::size_t>(std::max(40.0F, ImGui::GetContentRegionAvail().x / (kColumn_px * style.scale())));
  curves_.gather(*shown.history, shown.models.jnd, shown.models.slots.size(), drawing.end_s - view.time.shown_s,
                 drawing.end_s, columns);
  const double highest_N = 1.05 * static_cast<double>(curves_.highest_force_N());
  force_scale_N_ = eased_scale(force_scale_N_, std::max({1.0, shown.usual_force_N, highest_N}));
  // A larger range than 8 JND would hide differences near 1 JND.
  error_scale_ =
      eased_scale(error_scale_, std::clamp(1.2 * static_cast<double>(curves_.highest_sustained_over_jnd()), 1.5, 8.0));
  return drawing;
}

void ForceCurves::draw_titles_of_force(const Drawing& drawing, float width) const {
  const ModelsView& models = drawing.shown.models;
  section_title(drawing.style, "FORCE");
  ImGui::SameLine();
  const bool reference = !drawing.predicts();
  if (reference) {
    const double now_N = models.any_now ? static_cast<double>(models.now.reference_N) : std::nan("");
    ImGui::TextColored(paint(text_colour(reference_colour(drawing.style.theme()), drawing.style.theme())), "%s N",
                       at_most_three_decimals(now_N).c_str());
    ImGui::SameLine();
  }
  const std::string words = reference
                                ? drawing.shown.reference_words
                                : drawing.shown.reference_words + ", band: where the active model expects it, 95 %";
  const float room = width - ImGui::GetCursorPosX();
  const bool brief = models.compared && ImGui::CalcTextSize(words.c_str()).x > room;
  ImGui::TextDisabled("%s", fitting(brief ? "of " + models.reference_name : words, room).c_str());
  tip((words + "\nForce of every model, and in green what they are compared with.\n"
               "The grey band is one just noticeable difference (JND) to either side.\n"
               "Marks at the top: missed deadlines, and in red faults (L lists them).\n"
               "Drag to zoom, turn the wheel to scroll back, double-click or press Space to continue.")
          .c_str());
  ImGui::SameLine(width + ImGui::GetStyle().WindowPadding.x);
  section_title(drawing.style, "AGAINST DEPTH");
  tip("The same force against the depth of the tool. Loading and unloading differ (hysteresis).\n"
      "Green: what the models are compared with; the band is one JND to either side; the active model in its colour.");
}

void ForceCurves::draw_titles_of_error(const Drawing& drawing) const {
  const bool difference = drawing.view.settings.difference;
  section_title(drawing.style, drawing.predicts() ? "PREDICTED ERROR / JND"
                               : difference       ? "DIFFERENCE / JND"
                                                  : "ERROR / JND, MEAN OVER 50 MS");
  ImGui::SameLine();
  if (drawing.shown.models.out_of_domain()) {
    ImGui::TextColored(paint(drawing.style.colours().fault), "away from the recorded data");
  } else if (drawing.view.time.paused) {
    ImGui::TextDisabled("paused; Space continues");
  } else {
    quiet_words(difference ? "outside the band a hand could feel it" : "above 1 a hand could feel it");
  }
  tip(difference ? "Model minus reference, in just noticeable differences: inside the band a hand cannot feel it.\n"
                   "V: its mean over 50 ms, as one line."
                 : "Mean difference over 50 ms, in just noticeable differences. Faint marks: the largest of a single "
                   "tick.\nV: the difference in its band.");
}

// Draws the common part of all plots: values at the mouse, and names at the right.
void ForceCurves::finish_plot(const Drawing& drawing, const LivePlot& plot,
                              float (*value)(const CurveColumn&, std::size_t), const char* unit) {
  CurveTime& time = drawing.view.time;
  if (handle_time_plot(plot, drawing.style, *drawing.shown.history, time, drawing.end_s)) hovered_ = true;
  std::vector<Reading> readings;
  const CurveColumn* under = curves_.at(time.hover_s);
  const CurveColumn* last = curves_.last();
  if (under != nullptr && !std::isnan(under->tick.reference_N))
    readings.push_back({"reference  " + at_most_three_decimals(static_cast<double>(under->tick.reference_N)) + " N",
                        reference_colour(drawing.style.theme())});
  const ModelsView& models = drawing.shown.models;
  for (std::size_t i = 0; i < models.slots.size(); ++i) {
    if (models.slots[i].state != SlotState::ready) continue;
    if (i == drawing.view.pointed && last != nullptr && !std::isnan(value(*last, i)))
      draw_label(plot, {models.slots[i].name, text_colour(drawing.colour(i), drawing.style.theme()),
                        plot.y_px(static_cast<double>(value(*last, i)))});
    if (under != nullptr && !std::isnan(value(*under, i)))
      readings.push_back(
          {models.slots[i].name + "  " + at_most_three_decimals(static_cast<double>(value(*under, i))) + unit,
           drawing.colour(i)});
  }
  draw_readings(plot, drawing.style, time, readings);
}

// Draws force against depth: the reference with its band, and the active model.
void ForceCurves::draw_loops(const Drawing& drawing, const ImVec2& size) {
  const ForceHistory& history = *drawing.shown.history;
  const ModelsView& models = drawing.shown.models;
  const double scale_N = force_scale_N_;
  const std::size_t first = history.first_at(drawing.end_s - drawing.view.time.shown_s);
  const std::size_t end = history.first_at(drawing.end_s);
  double deepest_mm = std::isfinite(drawing.shown.usual_depth_m) ? 1e3 * drawing.shown.usual_depth_m : 1.0;
  for (std::size_t i = first; i < end; ++i)
    deepest_mm = std::max(deepest_mm, 1e3 * static_cast<double>(history[i].depth_m));
  const LivePlot plot(drawing.style, size,
                      {{-0.04 * deepest_mm, round_up(deepest_mm)}, {-0.04 * scale_N, scale_N}, "mm", "N", true});
  const std::size_t step = std::max<std::size_t>(1, (end - first) / kLoopPoints);
  const std::size_t selected = models.selected;
  std::vector<ImVec2> reference, model;
  // Points that are closer to the last one than a pixel are not visible.
  const auto extend = [&plot](std::vector<ImVec2>& points, float depth_m, float force_N) {
    if (std::isnan(force_N)) return;
    const ImVec2 at(plot.x_px(1e3 * static_cast<double>(depth_m)), plot.y_px(static_cast<double>(force_N)));
    const bool close =
        !points.empty() && std::abs(at.x - points.back().x) < 1.0F && std::abs(at.y - points.back().y) < 1.0F;
    if (!close) points.push_back(at);
  };
  const auto flush = [&] {
    plot.line(reference, ink(reference_colour(drawing.style.theme())), kReferenceLine_px * drawing.style.scale());
    if (models.active() != nullptr)
      plot.line(model, ink(drawing.colour(selected)), kModelLine_px * drawing.style.scale());
    reference.clear();
    model.clear();
  };
  for (std::size_t i = first; i < end; i += step) {
    const HistoryPoint& point = history[i];
    if (!point.in_contact) {
      flush();
      continue;
    }
    extend(reference, point.depth_m, point.reference_N);
    extend(model, point.depth_m, point.force_N[selected]);
  }
  flush();
}

void ForceCurves::draw_force(const Drawing& drawing, const ImVec2& size) {
  const double scale_N = force_scale_N_;
  const LivePlot plot(drawing.style, size, drawing.axes({-0.04 * scale_N, scale_N}, "N", true));
  const CurvePainter paint_on{plot, curves_.columns(), drawing.view.time.zero_s};
  const float thin = drawing.style.scale();
  const Palette& p = drawing.style.colours();
  paint_on.jnd_band(ink(p.band));
  drawing.paint_prediction(
      paint_on, [](const CurveColumn& c) { return c.predicted_low_N; },
      [](const CurveColumn& c) { return c.predicted_high_N; });
  paint_on.curve(ink(reference_colour(drawing.style.theme())), kReferenceLine_px * thin,
                 [](const CurveColumn& c) { return c.tick.reference_N; });
  drawing.for_each_slot([&](std::size_t slot) {
    drawing.paint_slot(paint_on, slot, [slot](const CurveColumn& c) { return c.tick.force_N[slot]; });
  });
  paint_on.fault_marks(ink(p.quiet), ink(p.fault), 6.0F * thin);
  finish_plot(
      drawing, plot, [](const CurveColumn& c, std::size_t slot) { return c.tick.force_N[slot]; }, " N");
}

void ForceCurves::draw_difference(const Drawing& drawing, float height) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const LivePlot plot(drawing.style, size, drawing.axes({-kDifference_jnd, kDifference_jnd}, "", true));
  const CurvePainter paint_on{plot, curves_.columns(), drawing.view.time.zero_s};
  const float thin = drawing.style.scale();
  plot.jnd_band(-1.0, 1.0);
  drawing.paint_prediction(
      paint_on, [](const CurveColumn& c) { return -c.predicted_over_jnd; },
      [](const CurveColumn& c) { return c.predicted_over_jnd; });
  if (!drawing.predicts()) plot.level(0.0, ink(reference_colour(drawing.style.theme())), kReferenceLine_px * thin);
  drawing.for_each_slot([&](std::size_t slot) {
    drawing.paint_slot(
        paint_on, slot, [slot](const CurveColumn& c) { return c.low_over_jnd[slot]; },
        [slot](const CurveColumn& c) { return c.high_over_jnd[slot]; });
  });
  finish_plot(
      drawing, plot,
      [](const CurveColumn& c, std::size_t slot) {
        const bool below = -c.low_over_jnd[slot] > c.high_over_jnd[slot];
        return below ? c.low_over_jnd[slot] : c.high_over_jnd[slot];
      },
      " JND");
}

void ForceCurves::draw_sustained(const Drawing& drawing, float height) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const LivePlot plot(drawing.style, size, drawing.axes({0.0, error_scale_}, "", true));
  const CurvePainter paint_on{plot, curves_.columns(), drawing.view.time.zero_s};
  const float thin = drawing.style.scale();
  const Palette& p = drawing.style.colours();
  plot.jnd_band(0.0, 1.0);
  plot.level(1.0, ink(p.text), 1.5F * thin);
  drawing.paint_prediction(
      paint_on, [](const CurveColumn&) { return 0.0F; }, [](const CurveColumn& c) { return c.predicted_over_jnd; });
  drawing.for_each_slot([&](std::size_t slot) {
    for (const CurveColumn& column : curves_.columns()) {
      if (!(column.error_over_jnd[slot] > 1.0F)) continue;
      const ImVec2 at(plot.x_px(column.time_s - drawing.view.time.zero_s),
                      std::max(plot.y_px(static_cast<double>(column.error_over_jnd[slot])), plot.top() + thin));
      plot.list().AddRectFilled({at.x - thin, at.y - thin}, {at.x + thin, at.y + thin},
                                ink(drawing.colour(slot), 0.35F));
    }
    drawing.paint_slot(paint_on, slot, [slot](const CurveColumn& c) { return c.sustained_over_jnd[slot]; });
  });
  finish_plot(
      drawing, plot, [](const CurveColumn& c, std::size_t slot) { return c.sustained_over_jnd[slot]; }, " JND");
}

}  // namespace palpate
