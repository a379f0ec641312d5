// The layout of the window, and small parts of several panels, which draw at the cursor of the current ImGui window.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <imgui.h>

#include <string>

#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// A part of the window, in ImGui's coordinates.
struct SceneArea {
  ImVec2 at, size;
  bool holds(const ImVec2& point) const {
    return point.x >= at.x && point.y >= at.y && point.x < at.x + size.x && point.y < at.y + size.y;
  }
};

struct WindowLayout {
  SceneArea scene;
  SceneArea panel;
};

// The panel is beside the scene; below it where the width is less than 1.1 times the height.
WindowLayout lay_out(const ImVec2& window);

// The colour of a model's method, in another shade for each further model of that method.
Rgb slot_colour(const ModelsView& models, std::size_t slot, Theme theme);
// Draws the mark of a model: a disc, hollow for the recipe of the paper (2009).
void draw_mark(ImDrawList& list, const ImVec2& middle, float radius, bool paper, ImU32 colour, const UiStyle& style);

// text_size returns the size of `text`, text_at draws it on the picture. `wrap`: width of a line; 0: not wrapped.
ImVec2 text_size(ImFont* font, const std::string& text, float wrap = 0.0F);
void text_at(ImFont* font, const ImVec2& at, ImU32 colour, const std::string& text, float wrap = 0.0F);

// `text`, cut at a blank and with "..." at its end where it is wider than `room` pixels.
std::string fitting(const std::string& text, float room);
// Breaks lines of `width` at blanks only; Dear ImGui would also break after the decimal point of a number.
std::string in_lines(const std::string& text, float width);
// Draws secondary text on the rest of the line. Where it does not fit it is cut, and a tooltip has all of it.
void quiet_words(const std::string& text);
// Begins an ImGui window that fills `area`. Call ImGui::End afterwards.
void begin_panel(const char* name, const SceneArea& area);
void section_title(const UiStyle& style, const char* title);
// A tooltip for the last item, below or above it.
void tip(const char* text);

}  // namespace palpate
