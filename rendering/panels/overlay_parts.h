// The parts of the overlay over the picture that have files of their own. Internal to
// rendering/panels.
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

// Behind text of that place and size, on `list`: a plate with a margin, and at its left a
// stripe of a colour, where one is given.
void draw_plate(ImDrawList& list, const ImVec2& at, const ImVec2& size, const ImVec2& margin, ImU32 colour,
                std::optional<Rgb> stripe = std::nullopt);

// The verdict, large, below the title; its lower edge.
float draw_headline(const WindowView& shown, const UiStyle& style, const SceneArea& area);
// Over the blocks, and above what lies at the lower edge, so high.
void draw_labels(const WindowView& shown, const BlockView& blocks, const UiStyle& style, const SceneArea& area,
                 float lift);
// From the lower edge up to the big number's top, which stands so far above that edge.
float big_number_height(const UiStyle& style, float lift);
// The error of the active model as one number, in words, and the scale that its
// colour is from; so far above the lower edge.
void draw_big_number(const WindowView& shown, const UiStyle& style, const SceneArea& area, float lift);

// What can be opened in a folder: its folders ("name/"), then its files.
std::vector<std::string> pickable_files(const std::string& folder);

inline constexpr auto kDialog = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                                ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove;
// The next window: in the middle, and never larger than the whole.
void begin_in_the_middle();

// Windows in the middle.
void draw_device_words(LiveSession& session, const UiStyle& style, const SceneArea& area);
void draw_help(ViewState& view, const UiStyle& style, const std::vector<WindowCommand>& commands);
void draw_file_picker(ViewState& view, const OverlayActions& actions);
// `in_use`: the device that the session has, which nothing else can open.
void draw_device_list(ViewState& view, const std::string& in_use, const OverlayActions& actions);
void draw_scene_list(const LiveSession& session, ViewState& view, const OverlayActions& actions);
// How things are shown and compared: every choice with its state.
void draw_view_list(LiveSession& session, ViewState& view, const OverlayActions& actions);
// What to do with recordings: which to train on, which to test on.
void draw_offer(ViewState& view, const OverlayActions& actions);
// Notices, from `top_px` down.
void draw_toasts(const std::vector<Toast>& toasts, const UiStyle& style, const SceneArea& area, float top_px);
void draw_data_warning(const ModelsView& models, const UiStyle& style, const SceneArea& area, float top_px);

}  // namespace palpate::overlay
