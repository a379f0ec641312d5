#include "rendering/panels/panel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/ui/plot.h"
#include "scenes/worker/model_request.h"

namespace palpate {
namespace {

// Draws the slider of the number of centres, for the active model or for all that have centres.
void draw_centres(LiveSession& session, const ModelsView& models, ViewState& view) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("centres");
  ImGui::SameLine();
  int centres = models.active()->centres;
  if (view.requested_centres > 0 && (ImGui::IsMouseDown(ImGuiMouseButton_Left) || models.active()->refitting))
    centres = view.requested_centres;
  ImGui::SetNextItemWidth(-9.0F * ImGui::GetFontSize());
  if (ImGui::SliderInt("##centres", &centres, 1, kMostCentres, "%d",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
    view.requested_centres = centres;
    for (const std::size_t slot : models.listed()) {
      if (slot == models.selected || view.centres_together) session.models().refit(slot, centres);
    }
  }
  tip("Fits the active model again with this number of centres; with \"all\", every model that has centres.\n"
      "Drag to the left, and watch the curve leave its band.");
  ImGui::SameLine();
  ImGui::Checkbox("all", &view.centres_together);
  ImGui::SameLine();
  ImGui::TextDisabled("%s", models.active()->refitting ? "fits ..." : "");
}

// Decimal logarithms: 0.03 to 30 JND, and 0.1 us to above the budget of 1 ms.
constexpr Range kErrors{-1.6, 1.5}, kTimes{-1.0, 3.3};
constexpr double kBudget_us = 1000.0;

// Bins with fewer samples have no useful standard deviation.
constexpr std::uint64_t kFewestSamples = 20;

// The ends of the axes of draw_error_bins.
struct Limits {
  double force_N = 1.0;
  double error_N = 0.1;
};

Limits limits_of(const ModelsView& models) {
  Limits limits;
  for (const ModelView& slot : models.slots) {
    for (const ForceBin& bin : slot.errors.bins) {
      if (bin.force_N.count() < kFewestSamples) continue;
      limits.force_N = std::max(limits.force_N, bin.force_to_N);
      limits.error_N = std::max(limits.error_N, bin.error_N.mean() + bin.error_N.deviation());
    }
  }
  // The JND line is visible completely; larger maxima are cut at the top.
  limits.error_N = round_up(1.6 * std::max(limits.error_N, models.jnd.at(limits.force_N)));
  return limits;
}

void draw_slot(const LivePlot& plot, const ModelsView& models, std::size_t index, const UiStyle& style) {
  const bool selected = index == models.selected;
  const ModelView& slot = models.slots[index];
  const ImU32 colour = ink(slot_colour(models, index, style.theme()));
  const float size = style.scale();
  std::vector<ImVec2> spread;
  for (const ForceBin& bin : slot.errors.bins) {
    if (bin.force_N.count() < kFewestSamples) continue;
    const float x = plot.x_px(0.5 * (bin.force_from_N + bin.force_to_N));
    spread.emplace_back(x, plot.y_px(bin.error_N.mean() + bin.error_N.deviation()));
    plot.list().AddCircleFilled(spread.back(), (selected ? 4.0F : 3.0F) * size, colour);
    const float top = std::max(plot.y_px(bin.error_N.largest()), plot.top() + 4.0F * size);
    plot.list().AddTriangleFilled({x - 4.0F * size, top + 3.0F * size}, {x + 4.0F * size, top + 3.0F * size},
                                  {x, top - 4.0F * size}, colour);
  }
  plot.line(spread, colour, (selected ? 2.6F : 1.5F) * size);
}

// Draws the 99 % error against the time of a tick, the columns "99 %" and "ns" of the table.
void draw_verdict(const ModelsView& models, const UiStyle& style, float height) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float size = style.scale();
  const Palette& p = style.colours();
  {
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height}, {kTimes, kErrors, "us a tick", "", true});
    plot.jnd_band(kErrors.from, 0.0);
    plot.level(0.0, ink(p.text), 1.5F * size);
    const float budget_px = plot.x_px(std::log10(kBudget_us));
    plot.list().AddLine({budget_px, plot.top()}, {budget_px, plot.bottom()}, ink(p.fault), 1.5F * size);
    plot.caption("a hand could tell", plot.top());
    const float wide = ImGui::CalcTextSize("1 ms ").x;
    plot.list().AddText({budget_px - wide, plot.bottom() - line}, ink(p.quiet), "1 ms");
    for (const std::size_t slot : models.listed()) {
      const ModelView& view = models.slots[slot];
      if (view.state != SlotState::ready || view.errors.samples == 0 || slot == models.reference) continue;
      const double error =
          std::clamp(std::log10(std::max(view.errors.p99_error_over_jnd, 1e-9)), kErrors.from, kErrors.to);
      const ImVec2 at(plot.x_px(std::log10(std::max(1e-3 * view.tick_ns(), 0.1))), plot.y_px(error));
      const ImU32 colour = ink(slot_colour(models, slot, style.theme()));
      // The present error, at the right edge of the curves.
      const double now = std::abs(models.now.difference_over_jnd(slot, models.jnd));
      if (now > 0.0) {
        const float y = plot.y_px(std::clamp(std::log10(now), kErrors.from, kErrors.to));
        plot.list().AddLine(at, {at.x, y}, ink(slot_colour(models, slot, style.theme()), 0.5F), 1.2F * size);
        plot.list().AddLine({at.x - 4.0F * size, y}, {at.x + 4.0F * size, y}, colour, 1.5F * size);
      }
      draw_mark(plot.list(), at, (slot == models.selected ? 6.5F : 5.0F) * size, view.paper, colour, style);
      if (models.verdict.chosen != slot) continue;
      plot.list().AddText({at.x + 9.0F * size, at.y - 0.6F * ImGui::GetFontSize()}, ink(p.text), view.name.c_str());
    }
  }
  tip("For each model: the time of a whole tick, and the error that 99 % of the samples do not exceed.\n"
      "Left and low is better. Filled: this program's fits; hollow: the 2009 recipe. The dash is the present error.\n"
      "Both values are columns of the table. E shows the error against the force instead.");
}

// Draws mean + standard deviation and maximum of the error in each bin of the force, and the JND.
void draw_error_bins(const ModelsView& models, const UiStyle& style, float height) {
  const Limits limits = limits_of(models);
  {
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height},
                        {{0.0, limits.force_N}, {0.0, limits.error_N}, "N", "N"});
    const double ends[2] = {0.0, limits.force_N};
    std::vector<ImVec2> line;
    std::vector<ImVec2> floor;
    for (const double force_N : ends) {
      line.emplace_back(plot.x_px(force_N), plot.y_px(models.jnd.at(force_N)));
      floor.emplace_back(plot.x_px(force_N), plot.bottom());
    }
    plot.band(line, floor, ink(style.colours().band));
    plot.line(line, ink(style.colours().text), 1.5F * style.scale());
    for (const std::size_t slot : models.drawn()) draw_slot(plot, models, slot, style);
    plot.caption("JND", std::max(plot.top(), plot.y_px(models.jnd.offset_N) - 0.25F * (plot.bottom() - plot.top())));
  }
  tip("Error against force since the last reset (C), in steps of two JND.\nDots: mean + standard deviation. "
      "Triangles: the largest.\nBlack line: the just noticeable difference.");
}

}  // namespace

void draw_panel(ForceCurves& curves, LiveSession& session, const WindowView& shown, ViewState& view,
                const UiStyle& style, const SceneArea& area) {
  begin_panel("panel", area);
  const ModelsView& models = shown.models;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  // The plots share the height that the parts of fixed size leave.
  const float health_room = health_height(shown.health, view);
  const float rows = static_cast<float>(std::clamp<std::size_t>(models.listed().size(), 2, 8)) + 1.0F;
  const float table = rows * (ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().CellPadding.y + 1.0F) +
                      0.28F * ImGui::GetFontSize() + 3.0F;
  const float titles = line * 3.4F;
  const ModelView* active = models.active();
  const bool has_centres = active != nullptr && active->takes_centres;
  const float centres = has_centres ? ImGui::GetFrameHeightWithSpacing() : 0.0F;
  const float rest = std::max(6.0F * line, ImGui::GetContentRegionAvail().y - health_room - table - centres - titles);
  const bool bins = !view.details || rest > 14.0F * line;
  curves.draw(shown, view, style, rest * (bins ? 0.36F : 0.52F), rest * (bins ? 0.30F : 0.48F));
  draw_model_table(session, models, view, style, table);
  if (centres > 0.0F) draw_centres(session, models, view);
  if (bins) {
    section_title(style, view.verdict ? "ERROR / JND, TIME OF A TICK" : "ERROR AGAINST FORCE");
    ImGui::SameLine();
    quiet_words(models.counted);
    if (view.verdict) {
      draw_verdict(models, style, rest * 0.33F);
    } else {
      draw_error_bins(models, style, rest * 0.33F);
    }
  }
  draw_health(shown.health, view, style);
  ImGui::End();
}

}  // namespace palpate
