// The panel's plot below the table: what a tick of each model costs against its error; or the error against the
// force in bins.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// The number is the table's "99 %" column, the time its "ns".
void draw_verdict(const ModelsView& models, const UiStyle& style, float height);

// Mean and spread in bins, largest, and the JND.
void draw_error_bins(const ModelsView& models, const UiStyle& style, float height);

}  // namespace palpate
