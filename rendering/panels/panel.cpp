#include "rendering/panels/panel.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr auto kPanelWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                        ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground;

}  // namespace

bool away_from_data(const LiveSession& session) {
  if (session.slot_count() == 0 || !session.newest().tick.in_contact) return false;
  const SlotView& slot = session.slot(session.selected());
  return slot.state == SlotState::ready && slot.out_of_domain;
}

void section_title(const UiStyle& style, const char* title) {
  ImGui::TextColored(paint(style.colours().text), "%s", title);
}

void tip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void Panel::draw(LiveSession& session, ViewState& view, const UiStyle& style, const FrameFigures& frames,
                 const ImVec2& at, const ImVec2& size) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("panel", nullptr, kPanelWindow);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  // What has a fixed size first; the plots share the rest.
  const float health = line * static_cast<float>(health_lines(session, view));
  const float rows = static_cast<float>(std::clamp<std::size_t>(session.slot_count(), 2, 7)) + 1.0F;
  const float table =
      rows * (ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().CellPadding.y + 1.0F) + 2.0F;
  const float titles = line * 3.4F;
  const float rest = std::max(6.0F * line, ImGui::GetContentRegionAvail().y - health - table - titles);
  const bool bins = !view.details || rest > 14.0F * line;
  curves_.draw(session, view, style, rest * (bins ? 0.42F : 0.65F), rest * (bins ? 0.24F : 0.35F));
  draw_model_table(session, style, table);
  if (bins) {
    section_title(style, "ERROR AGAINST FORCE");
    ImGui::SameLine();
    ImGui::TextDisabled("mean + std, largest, JND line");
    draw_error_bins(session, style, rest * 0.34F);
  }
  draw_health(session, view, style, frames);
  ImGui::End();
}

}  // namespace palpate
