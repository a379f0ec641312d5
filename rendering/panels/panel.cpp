#include "rendering/panels/panel.h"

#include <algorithm>

#include "rendering/panels/panel_errors.h"
#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr auto kPanelWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                        ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground;

}  // namespace

void Panel::draw(LiveSession& session, ViewState& view, const UiStyle& style, const FrameFigures& frames,
                 const ImVec2& at, const ImVec2& size) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("panel", nullptr, kPanelWindow);
  const HealthView health = health_view(session);
  const ErrorsView errors = errors_view(session);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  // What has a fixed size first; the plots share the rest.
  const float health_height = line * static_cast<float>(health_lines(health, view));
  const float rows = static_cast<float>(std::clamp<std::size_t>(errors.models.slots.size(), 2, 7)) + 1.0F;
  const float table =
      rows * (ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().CellPadding.y + 1.0F) + 0.28F * ImGui::GetFontSize() + 3.0F;
  const float titles = line * 3.4F;
  const float rest = std::max(6.0F * line, ImGui::GetContentRegionAvail().y - health_height - table - titles);
  const bool bins = !view.details || rest > 14.0F * line;
  curves_.draw(force_view(session), view, style, rest * (bins ? 0.32F : 0.48F), rest * (bins ? 0.36F : 0.52F));
  if (const auto chosen = draw_model_table(errors.models, view.table_sort, style, table)) session.select(*chosen);
  if (bins) {
    section_title(style, "ERROR AGAINST FORCE");
    ImGui::SameLine();
    ImGui::TextDisabled("mean + std, largest, JND line");
    draw_error_bins(errors, style, rest * 0.32F);
  }
  draw_health(health, view, style, frames);
  ImGui::End();
}

}  // namespace palpate
