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
// A column to two pixels: finer is hardly seen and costs time.
constexpr float kColumn_px = 2.0F;
// JNDs to either side of 0 in the difference view: three times the band's own height.
constexpr double kDifference_jnd = 3.0;
constexpr float kPredictedAlpha = 0.28F;
constexpr float kLabelRoom = 7.4F;  // for names beside the curves, in heights of a line

// Towards a nice number above what is shown; down only from what is much too large, for an
// axis that moves under somebody's eyes is not read.
double eased_scale(double scale, double wanted) {
  const double target = round_up(wanted);
  if (target > scale) return scale + 0.25 * (target - scale);
  return scale > 2.0 * target ? scale + 0.05 * (target - scale) : scale;
}

// Within about a second: names do not change places at every tick.
float eased(float& place, float wanted) {
  place = place == 0.0F ? wanted : place + 0.05F * (wanted - place);
  return place;
}

// "voxel" of "voxel-25x11x11x11": what there is room for beside a curve.
std::string short_name(const SlotView& slot) {
  constexpr std::size_t kMost = 14;
  return slot.name.size() <= kMost ? slot.name : slot.name.substr(0, std::min(kMost, slot.name.find('-')));
}

}  // namespace

struct ForceCurves::Scene {
  const ForceView& force;
  ViewState& view;
  const UiStyle& style;
  double end_s = 0.0;

  Rgb colour(std::size_t slot) const { return slot_colour(force.models, slot, style.theme()); }
  // Nothing to compare with: what the active model predicts of its own error.
  bool predicts() const { return !force.models.compared && force.models.active() != nullptr; }
  template <typename Low, typename High>
  void paint_prediction(const CurvePainter& paint_on, Low low, High high) const {
    if (predicts()) paint_on.band(ink(colour(force.models.selected), kPredictedAlpha), low, high);
  }
  bool names() const { return ImGui::GetContentRegionAvail().x > 24.0F * ImGui::GetFontSize(); }
  // Of models that are not the active one; what is dark is hard enough to see on black.
  float faint() const { return style.theme() == Theme::dark ? 0.95F : 0.75F; }
  // The models in the order of drawing: the active one on top.
  template <typename Draw>
  void for_each_slot(Draw draw) const {
    const ModelsView& models = force.models;
    for (std::size_t i = 0; i < models.slots.size(); ++i) {
      if (i != models.selected && models.slots[i]->state == SlotState::ready) draw(i);
    }
    if (models.active() != nullptr) draw(models.selected);
  }
  template <typename Low, typename High>
  void paint_slot(const CurvePainter& paint_on, std::size_t slot, Low low, High high) const {
    const bool selected = slot == force.models.selected;
    paint_on.curve(ink(colour(slot), selected ? 1.0F : faint()),
                   (selected ? kSelectedLine_px : kModelLine_px) * style.scale(), low, high);
  }
  template <typename Value>
  void paint_slot(const CurvePainter& paint_on, std::size_t slot, Value value) const {
    paint_slot(paint_on, slot, value, value);
  }
  PlotAxes axes(const Range& y, const char* unit, bool x_numbers) const {
    return {{end_s - view.time.shown_s - view.time.zero_s, end_s - view.time.zero_s},
            y,
            "s",
            unit,
            x_numbers,
            names() ? kLabelRoom : 0.6F};
  }
};

void ForceCurves::draw(const ForceView& force, ViewState& view, const UiStyle& style, float force_height,
                       float error_height) {
  const Scene scene = begin(force, view, style);
  draw_titles_of_force(scene);
  draw_force(scene, force_height);
  draw_titles_of_error(scene);
  if (view.difference) {
    draw_difference(scene, error_height);
  } else {
    draw_felt(scene, error_height);
  }
  if (!hovered_) view.time.hover_s = std::nan("");
}

ForceCurves::Scene ForceCurves::begin(const ForceView& force, ViewState& view, const UiStyle& style) {
  hovered_ = false;
  const Scene scene{force, view, style, view.time.end_s(steady_now_s())};
  const auto columns = static_cast<std::size_t>(std::max(40.0F, ImGui::GetContentRegionAvail().x / kColumn_px));
  curves_.gather(*force.history, force.models.jnd, force.models.slots.size(), scene.end_s - view.time.shown_s,
                 scene.end_s, columns);
  const double highest_N = 1.05 * static_cast<double>(curves_.highest_force_N());
  view.force_scale_N = eased_scale(view.force_scale_N, std::max({1.0, force.usual_force_N, highest_N}));
  // Beyond 8 JND the line would only hide what is near 1.
  view.error_scale =
      eased_scale(view.error_scale, std::clamp(1.2 * static_cast<double>(curves_.highest_felt_over_jnd()), 1.5, 8.0));
  return scene;
}

void ForceCurves::draw_titles_of_force(const Scene& scene) const {
  const HistoryPoint* now = scene.force.models.now;
  const double reference_N = now != nullptr ? static_cast<double>(now->reference_N) : std::nan("");
  section_title(scene.style, "FORCE");
  ImGui::SameLine();
  if (scene.predicts()) {
    quiet_words(scene.force.reference_words + ", band: where the active model expects it, 95 %");
  } else {
    ImGui::TextColored(paint(kReferenceColour), "%s N", at_most_three_decimals(reference_N).c_str());
    ImGui::SameLine();
    quiet_words(scene.force.reference_words);
  }
  tip("Force of every model, and in green what they are compared with (F chooses another).\n"
      "The grey band is one just noticeable difference (JND) either way.\n"
      "Marks at the top: missed deadlines, and in red faults (L lists them).\n"
      "On the curves: drag to zoom, wheel to go back, double click or Space to go on.");
}

void ForceCurves::draw_titles_of_error(const Scene& scene) const {
  const bool difference = scene.view.difference;
  section_title(scene.style, scene.predicts() ? "PREDICTED ERROR / JND"
                             : difference     ? "DIFFERENCE / JND"
                                              : "FELT ERROR / JND");
  ImGui::SameLine();
  if (scene.force.models.out_of_domain()) {
    ImGui::TextColored(paint(scene.style.colours().fault), "away from the recorded data");
  } else if (scene.view.time.paused) {
    ImGui::TextDisabled("stopped, Space goes on");
  } else {
    quiet_words(difference ? "outside the band a hand could tell" : "above 1 a hand could tell");
  }
  tip(difference ? "Model minus reference, in just noticeable differences: inside the band a hand cannot tell.\n"
                   "V: what a hand feels of it, as one line."
                 : "Mean difference over 50 ms, in just noticeable differences. Faint marks: the largest of a single "
                   "tick.\nV: the difference in its band.");
}

// What all have: the mouse, its readings, names at the right.
void ForceCurves::finish_plot(const Scene& scene, const LivePlot& plot, float (*value)(const CurveColumn&, std::size_t),
                              const char* unit) {
  CurveTime& time = scene.view.time;
  if (handle_time_plot(plot, scene.style, *scene.force.history, time, scene.end_s)) hovered_ = true;
  std::vector<CurveLabel> labels;
  std::vector<Reading> readings;
  const CurveColumn* under = curves_.at(time.hover_s);
  const CurveColumn* last = curves_.last();
  if (under != nullptr && !std::isnan(under->tick.reference_N))
    readings.push_back({"reference  " + at_most_three_decimals(static_cast<double>(under->tick.reference_N)) + " N",
                        kReferenceColour});
  for (std::size_t i = 0; i < scene.force.models.slots.size(); ++i) {
    if (scene.force.models.slots[i]->state != SlotState::ready) continue;
    if (last != nullptr && !std::isnan(value(*last, i)))
      labels.push_back({short_name(*scene.force.models.slots[i]), scene.colour(i),
                        eased(label_px_[unit[1] == 'N' ? 0 : 1][i], plot.y_px(static_cast<double>(value(*last, i))))});
    if (under != nullptr && !std::isnan(value(*under, i)))
      readings.push_back({scene.force.models.slots[i]->name + "  " +
                              at_most_three_decimals(static_cast<double>(value(*under, i))) + unit,
                          scene.colour(i)});
  }
  if (scene.names()) draw_labels(plot, labels);
  draw_readings(plot, scene.style, time, readings);
}

void ForceCurves::draw_force(const Scene& scene, float height) {
  const double scale_N = scene.view.force_scale_N;
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const LivePlot plot(scene.style, size, scene.axes({-0.04 * scale_N, scale_N}, "N", false));
  const CurvePainter paint_on{plot, curves_.columns(), scene.view.time.zero_s};
  const float thin = scene.style.scale();
  const Palette& p = scene.style.colours();
  paint_on.jnd_band(ink(p.band));
  scene.paint_prediction(
      paint_on, [](const CurveColumn& c) { return c.predicted_low_N; },
      [](const CurveColumn& c) { return c.predicted_high_N; });
  paint_on.curve(ink(kReferenceColour), kReferenceLine_px * thin,
                 [](const CurveColumn& c) { return c.tick.reference_N; });
  scene.for_each_slot([&](std::size_t slot) {
    scene.paint_slot(paint_on, slot, [slot](const CurveColumn& c) { return c.tick.force_N[slot]; });
  });
  paint_on.troubles(ink(p.quiet), ink(p.fault), 6.0F * thin);
  finish_plot(
      scene, plot, [](const CurveColumn& c, std::size_t slot) { return c.tick.force_N[slot]; }, " N");
}

void ForceCurves::draw_difference(const Scene& scene, float height) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const LivePlot plot(scene.style, size, scene.axes({-kDifference_jnd, kDifference_jnd}, "", true));
  const CurvePainter paint_on{plot, curves_.columns(), scene.view.time.zero_s};
  const float thin = scene.style.scale();
  const Palette& p = scene.style.colours();
  plot.list().AddRectFilled({plot.left(), plot.y_px(1.0)}, {plot.right(), plot.y_px(-1.0)}, ink(p.band));
  scene.paint_prediction(
      paint_on, [](const CurveColumn& c) { return -c.predicted_over_jnd; },
      [](const CurveColumn& c) { return c.predicted_over_jnd; });
  if (!scene.predicts()) plot.level(0.0, ink(kReferenceColour), kReferenceLine_px * thin);
  scene.for_each_slot([&](std::size_t slot) {
    scene.paint_slot(
        paint_on, slot, [slot](const CurveColumn& c) { return c.low_over_jnd[slot]; },
        [slot](const CurveColumn& c) { return c.high_over_jnd[slot]; });
  });
  finish_plot(
      scene, plot,
      [](const CurveColumn& c, std::size_t slot) {
        const bool below = -c.low_over_jnd[slot] > c.high_over_jnd[slot];
        return below ? c.low_over_jnd[slot] : c.high_over_jnd[slot];
      },
      " JND");
}

void ForceCurves::draw_felt(const Scene& scene, float height) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const LivePlot plot(scene.style, size, scene.axes({0.0, scene.view.error_scale}, "", true));
  const CurvePainter paint_on{plot, curves_.columns(), scene.view.time.zero_s};
  const float thin = scene.style.scale();
  const Palette& p = scene.style.colours();
  plot.list().AddRectFilled({plot.left(), plot.y_px(1.0)}, {plot.right(), plot.bottom()}, ink(p.band, 0.45F));
  plot.level(1.0, ink(p.text), 1.5F * thin);
  scene.paint_prediction(
      paint_on, [](const CurveColumn&) { return 0.0F; }, [](const CurveColumn& c) { return c.predicted_over_jnd; });
  scene.for_each_slot([&](std::size_t slot) {
    for (const CurveColumn& column : curves_.columns()) {
      if (!(column.error_over_jnd[slot] > 1.0F)) continue;
      const ImVec2 at(plot.x_px(column.time_s - scene.view.time.zero_s),
                      std::max(plot.y_px(static_cast<double>(column.error_over_jnd[slot])), plot.top() + thin));
      plot.list().AddRectFilled({at.x - thin, at.y - thin}, {at.x + thin, at.y + thin}, ink(scene.colour(slot), 0.35F));
    }
    scene.paint_slot(paint_on, slot, [slot](const CurveColumn& c) { return c.felt_over_jnd[slot]; });
  });
  finish_plot(
      scene, plot, [](const CurveColumn& c, std::size_t slot) { return c.felt_over_jnd[slot]; }, " JND");
}

}  // namespace palpate
