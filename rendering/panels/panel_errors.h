// The panel's plot below the table: the panel's answer, what a tick of each model costs
// against what a hand could tell of its error, as a plot and as one sentence from the same
// numbers; or the error against the force in bins.
// Thread guarantee: the window's thread, inside a frame; the words need no window.
#pragma once

#include <string>

#include "rendering/panels/panel_views.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// "greedy-100: 100 % unnoticeable at 0.61 us a tick; direct the same at 3.9 us;
// random-10 '09 40 %". The cheapest of those of whose errors a hand can tell at most one
// sample in a hundred comes first; without one, the nearest to it.
std::string verdict_words(const ModelsView& models);

// The number is the table's "99 %" column, the time its "ns".
void draw_verdict(const ModelsView& models, const UiStyle& style, float height);

// Mean and spread in bins, largest, and the JND.
void draw_error_bins(const ModelsView& models, const UiStyle& style, float height);

}  // namespace palpate
