#include "rendering/panels/panel.h"

#include <algorithm>
#include <string>

#include "rendering/panels/panel_errors.h"
#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_parts.h"
#include "scenes/worker/slot_plan.h"

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
      if (slot == models.selected || view.centres_together) session.refit(slot, centres);
    }
  }
  tip("Fits the active model again with this number of centres; with \"all\", every model that has centres.\n"
      "Drag to the left, and watch the curve leave its band.");
  ImGui::SameLine();
  ImGui::Checkbox("all", &view.centres_together);
  ImGui::SameLine();
  ImGui::TextDisabled("%s", models.active()->refitting ? "fits ..." : "");
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
