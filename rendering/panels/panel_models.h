// The panel's table of models.
// Thread guarantee: the window's thread, inside a frame; the words need no window.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// A click on a row makes its model the active one; a right click offers to rename it, to
// take it out, and to compare a model of something else.
void draw_model_table(LiveSession& session, const ModelsView& models, ViewState& view, const UiStyle& style,
                      float height);
// The columns of that table that `room` holds, dropped in a fixed order: the error in
// millinewtons first, then centres, time, force, error over the JND. Name and share
// within the JND always stay.
std::vector<int> shown_columns(float room, float (*width)(int column));

// What a row says in place of figures: "waits", "fits 40 %", "failed".
std::string waiting_words(const ModelInfo& slot);
// The tooltip of a row.
std::string name_tip(const ModelsView& models, std::size_t slot);

}  // namespace palpate
