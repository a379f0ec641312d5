// Small parts that several panels use, at the cursor of the current ImGui window.
#pragma once

#include <cstdint>
#include <string>

#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// The colour of a model: of its method, another shade for each further one of it.
Rgb slot_colour(const ModelsView& models, std::size_t slot, Theme theme);
// The mark of a model: filled, or hollow for the recipe of 2009.
void draw_mark(ImDrawList& list, const ImVec2& middle, float radius, bool paper, ImU32 colour, const UiStyle& style);

// The beginning of `text` that fits into `room` pixels, ending in "..." where it is cut.
std::string fitting(const std::string& text, float room);
// "33,275"
std::string grouped(std::uint64_t count);
// An error over the JND.
std::string jnd_text(double error_over_jnd);
// Second-rank words on the rest of the line; cut where they do not fit, and then whole
// in a tooltip.
void quiet_words(const std::string& text);
void section_title(const UiStyle& style, const char* title);
// A tooltip for the item before, below it or above it, never over it.
void tip(const char* text);

}  // namespace palpate
