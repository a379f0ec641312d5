// The panel's table of models.
// Thread guarantee: the window's thread, inside a frame; the words need no window.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "rendering/panels/panel_views.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// Returns the slot that was clicked.
std::optional<std::size_t> draw_model_table(const ModelsView& models, const UiStyle& style, float height);

// What a row says in place of figures: "waits", "fits 40 %", "failed".
std::string waiting_words(const SlotView& slot);
// The tooltip of a row.
std::string name_tip(const ModelsView& models, std::size_t slot);

}  // namespace palpate
