// The panel's table of models.
// Thread guarantee: the window's thread, inside a frame; `shown_columns` is a pure function.
#pragma once

#include <string>
#include <vector>

#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// A click on a row makes its model the active one. A right click opens a menu to rename it, to remove it, and to
// compare a model of another material.
void draw_model_table(LiveSession& session, const ModelsView& models, ViewState& view, const UiStyle& style,
                      float height);
// Which other models have the forces of this one, and why; empty: none. Begins with a line break.
std::string equal_words(const ModelInfo& info);
// The columns of that table that fit into `room`; `width` gives the width of a column. They are dropped in this order:
// error in mN, centres, time, force, 99 % error. Name and share within the JND always stay.
std::vector<int> shown_columns(float room, float (*width)(int column));

}  // namespace palpate
