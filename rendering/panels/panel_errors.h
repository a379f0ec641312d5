// The panel's error against force: mean and spread in bins, largest, and the JND.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/panel_views.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

void draw_error_bins(const ModelsView& models, const UiStyle& style, float height);

}  // namespace palpate
