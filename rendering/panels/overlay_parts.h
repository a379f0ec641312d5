// The parts of the overlay (scene_overlay.h). Internal to rendering/panels.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "rendering/panels/scene_overlay.h"

namespace palpate::overlay {

inline constexpr auto kFloating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground |
                                  ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                                  ImGuiWindowFlags_NoNav;

inline ImVec2 text_size(ImFont* font, const std::string& text, float wrap = 0.0F) {
  return font->CalcTextSizeA(height_of(font), 1e6F, wrap, text.c_str());
}
inline void text_at(ImFont* font, const ImVec2& at, ImU32 colour, const std::string& text, float wrap = 0.0F) {
  ImGui::GetBackgroundDrawList()->AddText(font, height_of(font), at, colour, text.c_str(), nullptr, wrap);
}

// Draws a plate with a margin behind text at `at` of `size`, optionally with a coloured stripe at its left.
void draw_plate(ImDrawList& list, const ImVec2& at, const ImVec2& size, const ImVec2& margin, ImU32 colour,
                std::optional<Rgb> stripe = std::nullopt);

// `lift` in these functions: height of other parts at the lower edge of `area`.

// Draws the verdict below the title. Returns the y of its lower edge.
float draw_headline(const WindowView& shown, const UiStyle& style, const SceneArea& area);
// Draws the names of the blocks.
void draw_labels(const WindowView& shown, const BlockView& blocks, const UiStyle& style, const SceneArea& area,
                 float lift);
// The height of draw_big_number plus `lift`.
float big_number_height(const UiStyle& style, float lift);
// Draws the error of the active model as a large number with its description, and the colour scale of errors.
void draw_big_number(const WindowView& shown, const UiStyle& style, const SceneArea& area, float lift);

// The entries of a folder that can be opened: its folders ("name/"), then its files.
std::vector<std::string> pickable_files(const std::string& folder);

// Begins a dialog in the middle of the window, if it is open. Call ImGui::End if this returns true.
bool begin_dialog(const char* title, bool& open);
// Whether Enter was pressed in this frame.
bool enter_pressed();
// An entry of a list. Returns whether it was chosen with the mouse, the space bar or Enter.
bool list_entry(const std::string& text, bool selected = false, bool enabled = true);

// Dialogs in the middle.
void draw_device_words(LiveSession& session, const UiStyle& style, const SceneArea& area);
void draw_help(ViewState& view, const UiStyle& style, const std::vector<WindowCommand>& commands);
void draw_file_picker(ViewState& view, const OverlayActions& actions);
// `in_use`: the device of the session, which cannot be opened a second time.
void draw_device_list(ViewState& view, const std::string& in_use, const OverlayActions& actions);
void draw_scene_list(const LiveSession& session, ViewState& view, const OverlayActions& actions);
// Choices of the display and the comparison.
void draw_view_list(LiveSession& session, ViewState& view, const OverlayActions& actions);
// Asks which recordings to train and to test on.
void draw_recording_roles(ViewState& view, const OverlayActions& actions);
// Draws notices from `top_px` downwards.
void draw_toasts(const std::vector<Toast>& toasts, const UiStyle& style, const SceneArea& area, float top_px);
void draw_data_warning(const ModelsView& models, const UiStyle& style, const SceneArea& area, float top_px);

}  // namespace palpate::overlay
