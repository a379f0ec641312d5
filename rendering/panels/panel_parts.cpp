#include "rendering/panels/panel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "scenes/worker/model_worker.h"

namespace palpate {

constexpr float kSceneShare = 0.6F;    // of the width
constexpr float kSceneHeight = 0.45F;  // of the height, above the panel
constexpr float kTall = 1.1F;          // ratio of width to height below which the panel is below the scene

WindowLayout lay_out(const ImVec2& window) {
  WindowLayout layout;
  if (window.x < kTall * window.y) {
    const float height = std::round(kSceneHeight * window.y);
    layout.scene = {{0.0F, 0.0F}, {window.x, height}};
    layout.panel = {{0.0F, height}, {window.x, window.y - height}};
  } else {
    const float width = std::round(kSceneShare * window.x);
    layout.scene = {{0.0F, 0.0F}, {width, window.y}};
    layout.panel = {{width, 0.0F}, {window.x - width, window.y}};
  }
  return layout;
}

ImVec2 text_size(ImFont* font, const std::string& text, float wrap) {
  return font->CalcTextSizeA(height_of(font), 1e6F, wrap, text.c_str());
}

void text_at(ImFont* font, const ImVec2& at, ImU32 colour, const std::string& text, float wrap) {
  ImGui::GetBackgroundDrawList()->AddText(font, height_of(font), at, colour, text.c_str(), nullptr, wrap);
}

std::string fitting(const std::string& text, float room) {
  if (ImGui::CalcTextSize(text.c_str()).x <= room) return text;
  std::string cut = text;
  while (!cut.empty()) {
    const std::size_t blank = cut.rfind(' ');
    cut.resize(blank == std::string::npos ? 0 : blank);
    const std::string shown = cut + " ...";
    if (ImGui::CalcTextSize(shown.c_str()).x <= room) return shown;
  }
  return {};
}

std::string in_lines(const std::string& text, float width, ImFont* font) {
  if (font == nullptr) font = ImGui::GetFont();
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = line.empty() ? word : line + " " + word;
    const bool fits = line.empty() || text_size(font, longer).x <= width;
    if (!fits) lines += line + "\n";
    line = fits ? longer : word;
  }
  return lines + line;
}

void quiet_words(const std::string& text) {
  const std::string shown = fitting(text, ImGui::GetContentRegionAvail().x);
  ImGui::TextDisabled("%s", shown.c_str());
  if (shown != text) tip(text.c_str());
}

void begin_panel(const char* name, const SceneArea& area) {
  ImGui::SetNextWindowPos(area.at);
  ImGui::SetNextWindowSize(area.size);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground);
}

void section_title(const UiStyle& style, const char* title) {
  ImGui::TextColored(paint(style.colours().text), "%s", title);
}

namespace {

// Which of the listed models of its method this is, from 0.
std::size_t among_its_method(const ModelsView& models, std::size_t slot) {
  const auto hue = [&](std::size_t i) { return method_colour(models.slots[i].method, Theme::light); };
  std::size_t which = 0;
  for (const std::size_t i : models.listed()) {
    if (i == slot) break;
    if (hue(i) == hue(slot)) ++which;
  }
  return which;
}

}  // namespace

Rgb slot_colour(const ModelsView& models, std::size_t slot, Theme theme) {
  return method_colour(models.slots[slot].method, theme, among_its_method(models, slot));
}

// A method's pattern follows from its place in the table of methods, so that it is the same in every session.
Dashes slot_dashes(const ModelsView& models, std::size_t slot) {
  constexpr Dashes kPatterns[] = {{0.0F, 0.0F}, {14.0F, 4.0F}, {7.0F, 3.0F}, {3.0F, 3.0F}, {22.0F, 7.0F}};
  const std::vector<MethodChoice>& methods = method_choices();
  const auto method = std::ranges::find(methods, models.slots[slot].method, &MethodChoice::family);
  const auto place = static_cast<std::size_t>(method - methods.begin());
  return kPatterns[(place + among_its_method(models, slot)) % std::size(kPatterns)];
}

void draw_mark(ImDrawList& list, const ImVec2& middle, float radius, bool paper, ImU32 colour, const UiStyle& style) {
  list.AddCircleFilled(middle, radius, colour);
  if (paper) list.AddCircleFilled(middle, 0.5F * radius, ink(style.colours().panel));
}

void tip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), all = ImGui::GetIO().DisplaySize;
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const float gap = 0.3F * ImGui::GetFontSize(), room = ImGui::GetWindowPos().x - gap - 2.0F * padding.x;
  ImVec2 size = ImGui::CalcTextSize(text);
  // Of several lines.
  const bool beside = size.y > 1.5F * ImGui::GetFontSize() && room > 20.0F * ImGui::GetFontSize();
  if (beside && size.x > room) size = ImGui::CalcTextSize(text, nullptr, false, room);
  const float wide = size.x + 2.0F * padding.x, tall = size.y + 2.0F * padding.y, above = low.y - gap - tall;
  const float x = beside ? ImGui::GetWindowPos().x - gap - wide : low.x;
  const float y = beside ? low.y : above >= 0.0F ? above : high.y + gap;
  ImGui::SetNextWindowPos(
      {std::clamp(x, 0.0F, std::max(0.0F, all.x - wide)), std::clamp(y, 0.0F, std::max(0.0F, all.y - tall))});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(padding.x + size.x + 1.0F);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace palpate
