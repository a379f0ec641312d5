// The panel's plot below the table: the error of each model against the time of its tick, or the error against the
// force in bins.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// The 99 % error against the time of a tick, the columns "99 %" and "ns" of the table.
void draw_verdict(const ModelsView& models, const UiStyle& style, float height);

// Mean + standard deviation and maximum of the error in each bin of the force, and the JND.
void draw_error_bins(const ModelsView& models, const UiStyle& style, float height);

}  // namespace palpate
