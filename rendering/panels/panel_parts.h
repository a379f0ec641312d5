// Small parts that several panels use, at the cursor of the current ImGui window.
#pragma once

#include "rendering/ui/ui_style.h"

namespace palpate {

void section_title(const UiStyle& style, const char* title);
// A tooltip for the item before.
void tip(const char* text);

}  // namespace palpate
