#include "rendering/panels/panel_parts.h"

#include <imgui.h>

namespace palpate {

void section_title(const UiStyle& style, const char* title) {
  ImGui::TextColored(paint(style.colours().text), "%s", title);
}

void tip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

}  // namespace palpate
