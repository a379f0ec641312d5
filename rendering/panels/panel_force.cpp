#include "rendering/panels/panel_force.h"

#include <algorithm>
#include <cmath>

#include "engine/live/pacer.h"
#include "engine/base/text.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/ui/plot.h"

namespace palpate {
namespace {

constexpr float kReferenceLine_px = 2.4F;
constexpr float kModelLine_px = 1.4F;
constexpr float kSelectedLine_px = 2.0F;
// A column to two pixels: finer is hardly seen and costs time.
constexpr float kColumn_px = 2.0F;


// The loop time at the right edge of the curves.
double end_time_s(const ViewState& view) {
  return view.paused ? view.paused_at_s - view.scrolled_back_s : steady_now_s();
}

// The models' order of drawing: the active one on top.
template <typename Draw>
void for_each_slot(const ModelsView& models, const ViewState& view, Draw draw) {
  for (std::size_t i = 0; i < models.slots.size() && !view.kiosk; ++i) {
    if (i != models.selected && models.slots[i]->state == SlotState::ready) draw(i);
  }
  if (models.active() != nullptr) draw(models.selected);
}

ImU32 slot_ink(const ModelsView& models, const ViewState& view, std::size_t slot, const UiStyle& style) {
  if (view.hidden_choice > 0) return ink(style.colours().text);
  const bool selected = slot == models.selected;
  return ink(method_colour(models.slots[slot]->method, style.theme()), selected ? 1.0F : 0.75F);
}

void draw_band(const Plot& plot, const std::vector<CurveColumn>& columns, const UiStyle& style) {
  std::vector<ImVec2> upper;
  std::vector<ImVec2> lower;
  const auto flush = [&] {
    plot.band(upper, lower, ink(style.colours().band));
    upper.clear();
    lower.clear();
  };
  for (const CurveColumn& column : columns) {
    if (!column.any) continue;
    if (!column.reference) {
      flush();
      continue;
    }
    upper.emplace_back(plot.x_px(column.time_s), plot.y_px(static_cast<double>(column.band_high_N)));
    lower.emplace_back(plot.x_px(column.time_s), plot.y_px(static_cast<double>(column.band_low_N)));
  }
  flush();
}

// `value`: of a column, NaN where the curve is interrupted.
template <typename Low, typename High>
void draw_curve(const Plot& plot, const std::vector<CurveColumn>& columns, ImU32 colour, float thickness,
                Low low, High high) {
  std::vector<ImVec2> points;
  for (const CurveColumn& column : columns) {
    if (!column.any) continue;
    const auto bottom = static_cast<double>(low(column));
    const auto top = static_cast<double>(high(column));
    if (std::isnan(bottom) || std::isnan(top)) {
      plot.line(points, colour, thickness);
      points.clear();
      continue;
    }
    const float x = plot.x_px(column.time_s);
    const float y_low = plot.y_px(bottom);
    const float y_high = plot.y_px(top);
    // In the direction of travel: a line that turns on the spot has no width there.
    const bool falling = !points.empty() && y_low - points.back().y > points.back().y - y_high;
    points.emplace_back(x, falling ? y_high : y_low);
    if (y_low - y_high > 1.5F) points.emplace_back(x, falling ? y_low : y_high);
  }
  plot.line(points, colour, thickness);
}

// The timeline of faults along the upper edge: a tick for a missed deadline, a red
// triangle for what the force path had to deal with.
void draw_faults(const Plot& plot, const std::vector<CurveColumn>& columns, const UiStyle& style) {
  const float size = 6.0F * style.scale();
  for (const CurveColumn& column : columns) {
    const float x = plot.x_px(column.time_s);
    if (column.trouble == TickTrouble::late) {
      plot.list().AddLine({x, plot.top()}, {x, plot.top() + size}, ink(style.colours().quiet));
    } else if (column.trouble == TickTrouble::alarm) {
      plot.list().AddTriangleFilled({x - size, plot.top()}, {x + size, plot.top()},
                                    {x, plot.top() + 1.6F * size}, ink(style.colours().fault));
    }
  }
}

// Towards a nice number above what is shown, quickly up, slowly down.
double eased_scale(double scale, double wanted) {
  const double target = round_up(wanted);
  return scale + (target > scale ? 0.25 : 0.03) * (target - scale);
}

void scroll_with_wheel(const Plot& plot, const ForceView& force, ViewState& view, double end_s) {
  const float wheel = ImGui::GetIO().MouseWheel;
  if (!plot.hovered() || wheel == 0.0F) return;
  if (!view.paused) {
    view.paused = true;
    view.paused_at_s = end_s;
    view.scrolled_back_s = 0.0;
  }
  const double oldest_s = force.history->size() > 0 ? (*force.history)[0].loop_time_s : end_s;
  const double most_s = std::max(0.0, view.paused_at_s - kShown_s - oldest_s);
  view.scrolled_back_s = std::clamp(view.scrolled_back_s + static_cast<double>(wheel), 0.0, most_s);
}

}  // namespace

void ForceCurves::draw(const ForceView& force, ViewState& view, const UiStyle& style, float force_height,
                       float error_height) {
  const double end_s = end_time_s(view);
  gather(force, view, end_s);
  section_title(style, "FORCE");
  ImGui::SameLine();
  const double reference_N = force.reference_N;
  ImGui::TextColored(paint(kReferenceColour), "%s N", at_most_three_decimals(reference_N).c_str());
  ImGui::SameLine();
  ImGui::TextDisabled("%s", force.reference_words.c_str());
  tip("What the models are compared with. F chooses another.\nThe grey band is one just noticeable "
      "difference (JND) either way.");
  draw_force(force, view, style, force_height, end_s);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip(
        "Force of every model in the last 10 s, and the reference in green.\nThe grey band: what a hand "
        "cannot tell from the reference.\nMarks at the top: missed deadlines, and in red faults (L lists "
        "them).\nWheel: back in time. Space: stop and go.");
  section_title(style, "ERROR / JND");
  ImGui::SameLine();
  if (force.models.out_of_domain()) {
    ImGui::TextColored(paint(style.colours().fault), "away from the recorded data");
  } else {
    ImGui::TextDisabled(view.paused ? "stopped, Space goes on" : "above 1 a hand could tell");
  }
  draw_error(force, view, style, error_height, end_s);
  if (view.paused && ImGui::IsItemHovered())
    ImGui::SetTooltip("%.1f s before the stop", view.scrolled_back_s);
}

void ForceCurves::draw_for_visitors(const ForceView& force, ViewState& view, const UiStyle& style,
                                    float height) {
  const double end_s = end_time_s(view);
  gather(force, view, end_s);
  draw_force(force, view, style, height, end_s);
}

void ForceCurves::gather(const ForceView& force, ViewState& view, double end_s) {
  const auto columns =
      static_cast<std::size_t>(std::max(40.0F, ImGui::GetContentRegionAvail().x / kColumn_px));
  curves_.gather(*force.history, force.jnd, force.models.slots.size(), end_s - kShown_s, end_s, columns);
  view.force_scale_N =
      eased_scale(view.force_scale_N, std::max(1.0, 1.05 * static_cast<double>(curves_.highest_force_N())));
  // Beyond 8 JND the line would only hide what is near 1.
  view.error_scale = eased_scale(
      view.error_scale, std::clamp(1.1 * static_cast<double>(curves_.highest_error_over_jnd()), 1.5, 8.0));
}

void ForceCurves::draw_force(const ForceView& force, ViewState& view, const UiStyle& style, float height,
                             double end_s) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const Plot plot(style, size, {end_s - kShown_s, end_s}, {-0.04 * view.force_scale_N, view.force_scale_N},
                  "", "N", false);
  const float thin = style.scale();
  draw_band(plot, curves_.columns(), style);
  draw_curve(
      plot, curves_.columns(), ink(kReferenceColour), kReferenceLine_px * thin,
      [](const CurveColumn& c) { return c.reference ? c.reference_N : NAN; },
      [](const CurveColumn& c) { return c.reference ? c.reference_N : NAN; });
  for_each_slot(force.models, view, [&](std::size_t slot) {
    draw_curve(
        plot, curves_.columns(), slot_ink(force.models, view, slot, style),
        (slot == force.models.selected ? kSelectedLine_px : kModelLine_px) * thin,
        [slot](const CurveColumn& c) { return c.low_N[slot]; },
        [slot](const CurveColumn& c) { return c.high_N[slot]; });
  });
  draw_faults(plot, curves_.columns(), style);
  scroll_with_wheel(plot, force, view, end_s);
}

void ForceCurves::draw_error(const ForceView& force, const ViewState& view, const UiStyle& style,
                             float height, double end_s) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const Plot plot(style, size, {end_s - kShown_s, end_s}, {0.0, view.error_scale}, "", "", false);
  const float thin = style.scale();
  plot.list().AddRectFilled({plot.left(), plot.y_px(1.0)}, {plot.right(), plot.bottom()},
                            ink(style.colours().band, 0.45F));
  plot.level(1.0, ink(style.colours().text), 1.5F * thin);
  for_each_slot(force.models, view, [&](std::size_t slot) {
    const auto value = [slot](const CurveColumn& c) { return c.error_over_jnd[slot]; };
    draw_curve(plot, curves_.columns(), slot_ink(force.models, view, slot, style),
               (slot == force.models.selected ? kSelectedLine_px : kModelLine_px) * thin, value, value);
  });
}

}  // namespace palpate
