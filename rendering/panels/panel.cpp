#include "rendering/panels/panel.h"

#include <algorithm>
#include <vector>

#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_speed.h"
#include "rendering/ui/plot.h"
#include "scenes/worker/model_request.h"

namespace palpate {
namespace {

void draw_centres(LiveSession& session, const ModelsView& models, ViewState& view) {
  std::vector<std::size_t> slots = models.listed();
  std::erase_if(slots, [&](std::size_t slot) { return !models.slots[slot].takes_centres; });
  const bool refitting =
      std::any_of(slots.begin(), slots.end(), [&](std::size_t slot) { return models.slots[slot].refitting; });
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("centres");
  ImGui::SameLine();
  int centres = models.slots[slots.front()].centres;
  for (const std::size_t slot : slots) centres = std::max(centres, models.slots[slot].centres);
  if (view.requested_centres > 0 && (ImGui::IsMouseDown(ImGuiMouseButton_Left) || refitting))
    centres = view.requested_centres;
  ImGui::SetNextItemWidth(-4.0F * ImGui::GetFontSize());
  if (ImGui::SliderInt("##centres", &centres, 1, kMostCentres, "%d",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
    view.requested_centres = centres;
    for (const std::size_t slot : slots) session.models().refit(slot, centres);
  }
  tip("Fits every model that has centres again with this number of centres.\n"
      "Drag to the left, and watch the curves leave their band and the dots move.");
  ImGui::SameLine();
  ImGui::TextDisabled("%s", refitting ? "fits ..." : "");
}

// Bins with fewer samples have no useful standard deviation.
constexpr std::uint64_t kFewestSamples = 20;

// The ends of the axes of draw_error_bins.
struct Limits {
  double force_N = 1.0, error_N = 0.1;
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

// Draws mean + standard deviation and maximum of the error in each bin of the force, and the JND.
void draw_error_bins(const ModelsView& models, const UiStyle& style, float height) {
  const Limits limits = limits_of(models);
  {
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height},
                        {{0.0, limits.force_N}, {0.0, limits.error_N}, "N", "N"});
    std::vector<ImVec2> line, floor;
    for (const double force_N : {0.0, limits.force_N}) {
      line.emplace_back(plot.x_px(force_N), plot.y_px(models.jnd.at(force_N)));
      floor.emplace_back(plot.x_px(force_N), plot.bottom());
    }
    plot.band(line, floor, ink(style.colours().band));
    plot.line(line, ink(style.colours().text), 1.5F * style.scale());
    for (const std::size_t slot : models.drawn()) draw_slot(plot, models, slot, style);
    plot.caption("JND", std::max(plot.top(), plot.y_px(models.jnd.offset_N) - 0.25F * (plot.bottom() - plot.top())));
  }
  tip("Error against force, in steps of two JND.\nDots: mean + standard deviation. "
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
  const bool has_centres =
      std::ranges::any_of(models.drawn(), [&](std::size_t i) { return models.slots[i].takes_centres; });
  const float centres = has_centres ? ImGui::GetFrameHeightWithSpacing() : 0.0F;
  const float rest = std::max(6.0F * line, ImGui::GetContentRegionAvail().y - health_room - table - centres - titles);
  const bool bins = !view.details || rest > 14.0F * line;
  curves.draw(shown, view, style, rest * (bins ? 0.34F : 0.52F), rest * (bins ? 0.29F : 0.48F));
  draw_model_table(session, models, view, style, table);
  if (centres > 0.0F) draw_centres(session, models, view);
  if (bins) {
    section_title(style, view.verdict ? "ERROR / JND AGAINST TIME OF A TICK" : "ERROR AGAINST FORCE");
    ImGui::SameLine();
    quiet_words(models.counted);
    if (view.verdict) {
      draw_speed(models, style, rest * 0.36F);
    } else {
      draw_error_bins(models, style, rest * 0.36F);
    }
  }
  draw_health(shown.health, view, style);
  ImGui::End();
}

}  // namespace palpate
