#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "rendering/panels/panel.h"

namespace palpate {
namespace {

constexpr float kReferenceLine_px = 2.4F;
constexpr float kModelLine_px = 1.4F;
constexpr float kSelectedLine_px = 2.0F;
// Width of a column in a window of 1080 lines; a finer one is hardly visible and costs time.
constexpr float kColumn_px = 2.6F;
// Range of the difference view on both sides of 0: three times the height of the band.
constexpr double kDifference_jnd = 3.0;
// Factor on the strongest press for the axes, because a hand briefly exceeds the press that it aims at.
constexpr double kUsualOverStrongest = 1.5;
constexpr float kPredictedAlpha = 0.28F;
constexpr std::size_t kLongestPress = 30'000;  // ticks
// Largest number of points of a curve over depth: one for every few ticks in ten seconds.
constexpr std::size_t kLoopPoints = 1500;

// Moves the scale of an axis towards a round number above `wanted`. It decreases only if it is more than twice as
// large: an axis that moves is hard to read.
double eased_scale(double scale, double wanted) {
  constexpr double kSame = 0.01;  // a pixel of a plot: then it stops, because every motion is drawn
  const double target = round_up(wanted);
  if (target > scale) return target - scale < kSame * target ? target : scale + 0.25 * (target - scale);
  return scale > 2.0 * target ? scale + 0.05 * (target - scale) : scale;
}

Range single(float value) { return {value, value}; }
Range around(double middle, double half) { return {middle - half, middle + half}; }

// A quantity of a model at a tick.
using SlotValue = float (*)(const HistoryPoint& tick, std::size_t slot);

float force_of(const HistoryPoint& tick, std::size_t slot) { return tick.force_N[slot]; }
float sustained_of(const HistoryPoint& tick, std::size_t slot) { return tick.sustained_over_jnd[slot]; }

struct Drawing {
  const WindowView& shown;
  ViewState& view;
  const UiStyle& style;
  const CurveColumns& columns;
  double end_s = 0.0;  // loop time at the right edge
  bool hovered = false;

  const ModelsView& models() const { return shown.models; }
  float scale() const { return style.scale(); }
  Rgb colour(std::size_t slot) const { return slot_colour(models(), slot, style.theme()); }
  // Green is the truth; a model that the others are compared with has its own colour.
  Rgb reference() const {
    return models().reference == kReferenceBlock ? reference_colour(style.theme()) : colour(models().reference);
  }
  // Without a reference, the curves show the predicted error of the active model.
  bool predicts() const { return !models().compared && models().active() != nullptr; }
  double predicted_over_jnd(const CurveColumn& column) const {
    return predicted_error_N(column.tick) / models().jnd.at(column.tick.force_N[column.tick.active]);
  }

  TimePlot begin_plot(const ImVec2& size, const Range& y, const char* unit) const {
    return {style, size, y, unit, view.time, end_s, columns};
  }
  void fill_prediction(const TimePlot& plot, const ColumnRange& range) const {
    if (predicts()) plot.fill(ink(colour(models().selected), kPredictedAlpha), range);
  }

  void draw_titles_of_force(float width) const {
    ImGui::BeginGroup();
    section_title(style, "FORCE");
    ImGui::SameLine();
    std::string words = shown.reference_words;
    if (predicts()) {
      words += ", band: where the active model expects it, 95 %";
    } else {
      ImGui::TextColored(paint(text_colour(reference(), style.theme())), "%s N",
                         at_most_three_decimals(models().now.reference_N).c_str());
      ImGui::SameLine();
    }
    const float room = width - ImGui::GetCursorPosX();
    const bool brief = models().compared && ImGui::CalcTextSize(words.c_str()).x > room;
    ImGui::TextDisabled("%s", fitting(brief ? "of " + models().reference_name : words, room).c_str());
    ImGui::EndGroup();
    tip((words + "\nForce of every model, and on top what they are compared with.\n"
                 "The grey band is one just noticeable difference (JND) to either side.\n"
                 "Marks at the top: missed deadlines, and in red faults (L lists them).\n"
                 "Drag: blocks and numbers show that moment. Shift and drag: zoom. Wheel: scroll back.\n"
                 "Double-click or Space: continue.")
            .c_str());
    ImGui::SameLine(width + ImGui::GetStyle().WindowPadding.x);
    section_title(style, "AGAINST DEPTH");
    tip("The same force against the depth of the tool. Loading and unloading differ (hysteresis).\n"
        "Thin: what the models are compared with; thick: the active model. The dot is the moment that is shown.");
  }

  void draw_titles_of_error() const {
    ImGui::BeginGroup();
    section_title(style, predicts() ? "PREDICTED ERROR / JND" : "DIFFERENCE / JND");
    ImGui::SameLine();
    if (models().out_of_domain()) {
      ImGui::TextColored(paint(style.colours().fault), "away from the recorded data");
    } else if (models().stands) {
      quiet_words(view.worst           ? view.worst->words
                  : view.time.dragging ? "the moment under the mouse; let go to return"
                                       : "stands still; Space continues");
    } else {
      quiet_words("outside the band most people notice it");
    }
    ImGui::EndGroup();
    tip("Model minus reference, mean over 50 ms, in just noticeable differences: inside the band few people notice "
        "it.\n"
        "Faint marks: single ticks outside.");
  }

  void draw_curves(const TimePlot& plot, SlotValue value) const {
    for (const std::size_t slot : models().drawn()) {
      plot.curve(
          ink(colour(slot)), (slot == models().selected ? kSelectedLine_px : kModelLine_px) * scale(),
          [&](const CurveColumn& column) { return single(value(column.tick, slot)); }, slot_dashes(models(), slot));
    }
  }

  // Draws the values under the mouse; during a drag the table has them.
  void draw_readings(TimePlot& plot, SlotValue value, const char* unit) {
    if (plot.handle_mouse(*shown.history)) hovered = true;
    const HistoryPoint* under = view.time.dragging ? nullptr : shown.history->last_until(view.time.hover_s);
    if (under == nullptr) return;
    std::vector<CurveReading> readings;
    const auto read = [&](const std::string& name, const Rgb& in, float number, const char* of) {
      if (!std::isnan(number)) readings.push_back({name + "  " + at_most_three_decimals(number) + of, in});
    };
    read("reference", reference(), under->reference_N, " N");
    for (const std::size_t slot : models().listed())
      read(models().slots[slot].name, colour(slot), value(*under, slot), unit);
    plot.draw_readings(readings);
  }

  // Draws force against depth: the reference with its band, and the active model.
  void draw_loops(const ImVec2& size, double scale_N) {
    const ForceHistory& history = *shown.history;
    std::size_t first = history.first_at(end_s - view.time.shown_s);
    const std::size_t end = history.first_at(end_s);
    // The whole press, also after a long hold.
    for (std::size_t most = kLongestPress; first > 0 && first < end && most > 0 && history[first].in_contact; --most)
      --first;
    double deepest_mm = std::isfinite(shown.usual_depth_m) ? 1e3 * shown.usual_depth_m : 1.0;
    for (std::size_t i = first; i < end; ++i) deepest_mm = std::max(deepest_mm, 1e3 * history[i].depth_m);
    const LivePlot plot(style, size,
                        {{-0.04 * deepest_mm, round_up(deepest_mm)}, {-0.04 * scale_N, scale_N}, "mm", "N"});
    const std::size_t step = std::max<std::size_t>(1, (end - first) / kLoopPoints);
    std::vector<ImVec2> reference_points, model_points;
    // Points that are closer to the last one than a pixel are not visible.
    const auto extend = [&plot](std::vector<ImVec2>& points, float depth_m, float force_N) {
      if (std::isnan(force_N)) return;
      const ImVec2 at(plot.x_px(1e3 * depth_m), plot.y_px(force_N));
      const bool close =
          !points.empty() && std::abs(at.x - points.back().x) < 1.0F && std::abs(at.y - points.back().y) < 1.0F;
      if (!close) points.push_back(at);
    };
    const auto flush = [&] {
      if (models().active() != nullptr)
        plot.line(model_points, ink(colour(models().selected)), kSelectedLine_px * scale());
      plot.line(reference_points, ink(reference()), kModelLine_px * scale());
      reference_points.clear();
      model_points.clear();
    };
    for (std::size_t i = first; i < end; i += step) {
      const HistoryPoint& point = history[i];
      if (!point.in_contact) {
        flush();
        continue;
      }
      extend(reference_points, point.depth_m, point.reference_N);
      extend(model_points, point.depth_m, point.force_N[models().selected]);
    }
    flush();
    const auto at = [&](const HistoryPoint& point) {
      const float force_N = models().active() != nullptr ? point.force_N[models().selected] : point.reference_N;
      return ImVec2(plot.x_px(1e3 * point.depth_m), plot.y_px(force_N));
    };
    if (plot.hovered() || (view.time.dragging && plot.owns_drag())) {
      // The moment whose point is nearest to the mouse.
      const ImVec2 mouse = ImGui::GetIO().MousePos;
      float least_px = 1e6F;
      for (std::size_t i = first; i < end; i += step) {
        const ImVec2 point = at(history[i]);
        const float away_px = std::hypot(point.x - mouse.x, point.y - mouse.y);
        if (!history[i].in_contact || !(away_px < least_px)) continue;
        least_px = away_px;
        view.time.hover_s = history[i].loop_time_s;
        hovered = true;
      }
      if (hovered || !ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag_time(view.time, plot, view.time.hover_s, end_s);
    }
    const HistoryPoint* under = history.last_until(view.time.hover_s);
    const HistoryPoint* marked = under != nullptr ? under : models().stands ? &models().now : nullptr;
    if (marked != nullptr && !std::isnan(at(*marked).y))
      plot.list().AddCircleFilled(at(*marked), 4.0F * scale(), ink(style.colours().text));
  }

  void draw_force(const ImVec2& size, double scale_N) {
    TimePlot plot = begin_plot(size, {-0.04 * scale_N, scale_N}, "N");
    plot.fill(ink(style.colours().band),
              [](const CurveColumn& column) { return around(column.tick.reference_N, column.jnd_N); });
    for (const float side : {-1.0F, 1.0F}) {
      plot.curve(ink(style.colours().edge, 0.6F), scale(),
                 [side](const CurveColumn& column) { return single(column.tick.reference_N + side * column.jnd_N); });
    }
    fill_prediction(plot, [](const CurveColumn& column) {
      return around(column.tick.force_N[column.tick.active], predicted_error_N(column.tick));
    });
    draw_curves(plot, force_of);
    plot.curve(ink(reference()), kReferenceLine_px * scale(),
               [](const CurveColumn& column) { return single(column.tick.reference_N); });
    draw_readings(plot, force_of, " N");
    plot.fault_marks();
  }

  void draw_difference(const ImVec2& size) {
    TimePlot plot = begin_plot(size, {-kDifference_jnd, kDifference_jnd}, "");
    plot.jnd_band(-1.0, 1.0);
    fill_prediction(plot, [&](const CurveColumn& column) { return around(0.0, predicted_over_jnd(column)); });
    if (!predicts()) plot.level(0.0, ink(reference()), kReferenceLine_px * scale());
    for (const std::size_t slot : models().drawn()) {
      for (const CurveColumn& column : columns.columns()) {
        for (const float peak : {column.low_over_jnd[slot], column.high_over_jnd[slot]}) {
          const float x = plot.x_px(column.tick.loop_time_s - view.time.zero_s), r = scale();
          const float y = std::clamp(plot.y_px(peak), plot.top(), plot.bottom());
          if (std::abs(peak) > 1.0F)
            plot.list().AddRectFilled({x - r, y - r}, {x + r, y + r}, ink(colour(slot), 0.35F));
        }
      }
    }
    draw_curves(plot, sustained_of);
    draw_readings(plot, sustained_of, " JND");
  }
};

}  // namespace

void ForceCurves::draw(const WindowView& shown, ViewState& view, const UiStyle& style, float force_height,
                       float error_height) {
  Drawing drawing{shown, view, style, columns_, view.time.end_s(shown.now_s)};
  const float all = ImGui::GetContentRegionAvail().x;
  const auto count = static_cast<std::size_t>(std::max(40.0F, all / (kColumn_px * style.scale())));
  columns_.gather(*shown.history, shown.models.jnd, shown.models.slots.size(), drawing.end_s - view.time.shown_s,
                  drawing.end_s, count);
  const double highest_N = 1.05 * columns_.highest_force_N();
  force_scale_N_ =
      eased_scale(force_scale_N_, std::max({1.0, kUsualOverStrongest * shown.scene->strongest_press_N, highest_N}));
  drawing.draw_titles_of_force(kLeftShare * all);
  drawing.draw_force({kLeftShare * all - ImGui::GetStyle().ItemSpacing.x, force_height}, force_scale_N_);
  ImGui::SameLine();
  drawing.draw_loops({(1.0F - kLeftShare) * all, force_height}, force_scale_N_);
  drawing.draw_titles_of_error();
  drawing.draw_difference({all, error_height});
  if (!drawing.hovered) view.time.hover_s = std::nan("");
}

}  // namespace palpate
