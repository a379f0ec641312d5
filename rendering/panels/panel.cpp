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

Rgb slot_colour(const LiveSession& session, std::size_t slot, Theme theme) {
  const std::string& method = session.slot(slot).method;
  std::size_t which = 0;
  for (std::size_t i = 0; i < slot; ++i) {
    if (session.slot(i).method == method) ++which;
  }
  return method_colour(method, theme, which);
}

void tip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float gap = 0.3F * ImGui::GetFontSize();
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const ImVec2 size = ImGui::CalcTextSize(text);
  const float wide = size.x + 2.0F * padding.x;
  const float tall = size.y + 2.0F * padding.y;
  const float x = std::clamp(low.x, 0.0F, std::max(0.0F, all.x - wide));
  const bool below = high.y + gap + tall <= all.y;
  ImGui::SetNextWindowPos({x, below ? high.y + gap : low.y - gap - tall});
  ImGui::SetTooltip("%s", text);
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
      rows * (ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().CellPadding.y + 1.0F) + 0.28F * ImGui::GetFontSize() + 3.0F;
  const float titles = line * 3.4F;
  const float rest = std::max(6.0F * line, ImGui::GetContentRegionAvail().y - health - table - titles);
  const bool bins = !view.details || rest > 14.0F * line;
  curves_.draw(session, view, style, rest * (bins ? 0.32F : 0.48F), rest * (bins ? 0.36F : 0.52F));
  draw_model_table(session, view, style, table);
  if (bins) {
    section_title(style, "ERROR AGAINST FORCE");
    ImGui::SameLine();
    ImGui::TextDisabled("mean + std, largest, JND line");
    draw_error_bins(session, style, rest * 0.32F);
  }
  draw_health(session, view, style, frames);
  ImGui::End();
}

}  // namespace palpate
