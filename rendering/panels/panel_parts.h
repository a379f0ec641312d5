// Small parts that several panels use, at the cursor of the current ImGui window.
#pragma once

#include "rendering/panels/panel_views.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// The colour of a model: of its method, another shade for each further one of it.
Rgb slot_colour(const ModelsView& models, std::size_t slot, Theme theme);

void section_title(const UiStyle& style, const char* title);
// A tooltip for the item before, below it or above it, never over it.
void tip(const char* text);

}  // namespace palpate
