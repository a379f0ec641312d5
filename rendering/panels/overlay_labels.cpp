// Draws the labels of the blocks, the headline and the big number.
#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "rendering/panels/overlay_parts.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/ui/plot.h"

namespace palpate::overlay {
namespace {

// Top left corner of the label of block `index`. It is at the foot of the block, above the tool of a block in the rear
// row, and in the upper right corner of the picture for a single block.
ImVec2 label_place(const BlockView& blocks, std::size_t index, std::size_t count, const SceneArea& area,
                   const ImVec2& size, float lift) {
  if (count == 1) return {area.at.x + area.size.x - 1.15F * size.x - size.y, area.at.y + 2.6F * size.y};
  const bool behind = count > 2 && index < 2;
  if (behind) {
    // The length of the tool with a margin, because the tool is lifted between presses.
    const auto above = 16.0F * static_cast<float>(blocks.geometry().tool_radius_m);
    const glm::vec2 top = blocks.on_screen(index, count, {0.0F, above, 0.0F}, {area.size.x, area.size.y});
    // The two labels of the row share the width if it is small.
    const glm::vec2 other = blocks.on_screen(1 - index, count, {0.0F, above, 0.0F}, {area.size.x, area.size.y});
    const float middle = 0.5F * (top.x + other.x);
    const float gap = 0.5F * size.y;
    const float low = top.x > other.x ? middle + gap : 4.0F;
    const float high = (top.x > other.x ? area.size.x - 4.0F : middle - gap) - size.x;
    const float x = std::clamp(top.x - 0.5F * size.x, std::min(low, high), std::max(low, high));
    return {area.at.x + x, area.at.y + std::max(3.0F * size.y, top.y - 1.9F * size.y)};
  }
  const auto half = 0.5F * static_cast<float>(blocks.geometry().length_m);
  const auto height = static_cast<float>(blocks.geometry().height_m);
  // A point in front of the block, on the table.
  const glm::vec2 front =
      blocks.on_screen(index, count, {0.35F * half, -1.02F * height, 1.0F * half}, {area.size.x, area.size.y});
  const float x = std::clamp(front.x - 0.5F * size.x, 4.0F, area.size.x - size.x - 4.0F);
  const float y = std::clamp(front.y + 0.25F * size.y, 4.0F, area.size.y - lift - 1.2F * size.y);
  return {area.at.x + x, area.at.y + y};
}

// Draws text that is wrapped to the width `room`. Returns the y below it.
float draw_wrapped(ImFont* font, const ImVec2& at, const std::string& text, ImU32 colour, float room) {
  text_at(font, at, colour, text, room);
  return at.y + text_size(font, text, room).y;
}

}  // namespace

float draw_headline(const WindowView& shown, const UiStyle& style, const SceneArea& area) {
  const Verdict& verdict = shown.models.verdict;
  const float line = height_of(style.fonts().body);
  const float head = height_of(style.fonts().heading);
  const float top = area.at.y + 2.0F * line;
  if (verdict.headline.empty()) return top;
  const float indent = verdict.chosen ? 1.1F * head : 0.0F;
  const ImVec2 at(area.at.x + 0.7F * line + indent, top);
  const float room = area.size.x - indent - 1.4F * line;
  if (verdict.chosen) {
    const ModelView& model = shown.models.slots[*verdict.chosen];
    const ImU32 colour = ink(slot_colour(shown.models, *verdict.chosen, style.theme()));
    draw_mark(*ImGui::GetBackgroundDrawList(), {at.x - 0.6F * head, top + 0.55F * head}, 0.36F * head, model.paper,
              colour, style);
  }
  const Rgb& ink_of = verdict.chosen ? style.colours().text : style.colours().quiet;
  // No line ends between a number and its unit.
  std::string headline = verdict.headline;
  for (std::size_t i = 0; (i = headline.find(" %", i)) != std::string::npos;) headline.replace(i, 1, "\u00A0");
  float y = draw_wrapped(style.fonts().heading, at, headline, ink(ink_of), room);
  if (!verdict.detail.empty())
    y = draw_wrapped(style.fonts().body, {at.x, y + 0.1F * line}, verdict.detail, ink(style.colours().quiet), room);
  return y + 0.3F * line;
}

void draw_labels(const WindowView& shown, const BlockView& blocks, const UiStyle& style, const SceneArea& area,
                 float lift) {
  const std::vector<std::size_t>& slots = shown.blocks;
  ImFont* font = style.fonts().heading;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const bool reference = slots[i] == kReferenceBlock;
    const std::string text =
        reference ? shown.reference_block
                  : std::to_string(shown.models.number_of(slots[i])) + "  " + shown.models.slots[slots[i]].name;
    const ImVec2 size = text_size(font, text);
    const ImVec2 at = label_place(blocks, i, slots.size(), area, size, lift);
    const bool active = slots[i] == shown.models.selected;
    const bool best = shown.models.verdict.chosen == slots[i];
    const Rgb colour = reference ? reference_colour(style.theme()) : slot_colour(shown.models, slots[i], style.theme());
    const float pad = 0.25F * height_of(font);
    draw_plate(*ImGui::GetBackgroundDrawList(), at, size, {2.0F * pad, 0.5F * pad}, ink(style.colours().panel, 0.88F),
               colour);
    if (slots.size() > 1 && active) {
      ImGui::GetBackgroundDrawList()->AddRect({at.x - 2.0F * pad, at.y - 0.5F * pad},
                                              {at.x + size.x + 2.0F * pad, at.y + size.y + 0.5F * pad}, ink(colour),
                                              6.0F, 0, 2.0F);
    }
    text_at(font, at, ink(active || best ? style.colours().text : style.colours().quiet), text);
    if (!active && !best) continue;
    const std::string mark = best && active ? "best, and active" : best ? "best" : slots.size() > 1 ? "active" : "";
    const ImVec2 below = text_size(style.fonts().body, mark);
    text_at(style.fonts().body, {at.x + 0.5F * (size.x - below.x), at.y + size.y + 0.6F * pad},
            ink(style.colours().text), mark);
  }
}

float big_number_height(const UiStyle& style, float lift) {
  return lift + height_of(style.fonts().big) + 1.9F * height_of(style.fonts().body);
}

// Draws the big number, its explanation, and the scale of its colour.
void draw_big_number(const WindowView& shown_view, const UiStyle& style, const SceneArea& area, float lift) {
  const Palette& p = style.colours();
  ImFont* big = style.fonts().big;
  ImFont* body = style.fonts().body;
  const float line = height_of(body);
  const ImVec2 corner(area.at.x + 1.1F * line, area.at.y + area.size.y - lift);
  const BigNumber shown = big_number(shown_view.models, shown_view.reference_block == "the true material");
  ImVec2 size = text_size(big, "0.00");
  size.x = std::max(size.x, text_size(big, shown.number).x);
  const float y = area.at.y + area.size.y - big_number_height(style, lift);
  text_at(big, {corner.x, y}, ink(shown.error_over_jnd > 1.0 ? text_colour(kAboveJndColour, style.theme()) : p.text),
          shown.number);
  const float beside = corner.x + size.x + 0.7F * line;
  if (ImGui::IsMouseHoveringRect({corner.x, y}, {area.at.x + area.size.x, corner.y}))
    ImGui::SetTooltip(
        "99 %% of the samples in contact are off by at most this, in just noticeable differences (JND):\n"
        "the active row of the table, over %s",
        shown_view.models.counted.c_str());
  text_at(body, {beside, y + 0.30F * size.y}, ink(p.text), shown.what);
  text_at(body, {beside, y + 0.30F * size.y + 1.15F * line}, ink(p.quiet), shown.below);
  const float width = 11.0F * line;
  const float top = y + size.y + 0.35F * line;
  const float high = 0.55F * line;
  for (int i = 0; i < 40; ++i) {
    const float from = static_cast<float>(i) / 40.0F;
    ImGui::GetBackgroundDrawList()->AddRectFilled({corner.x + from * width, top},
                                                  {corner.x + (from + 0.025F) * width + 0.5F, top + high},
                                                  ink(error_colour(static_cast<double>(from))));
  }
  ImGui::GetBackgroundDrawList()->AddRect({corner.x, top}, {corner.x + width, top + high}, ink(p.edge));
  ImGui::GetBackgroundDrawList()->AddRectFilled({corner.x + width + 3.0F, top}, {corner.x + 1.3F * width, top + high},
                                                ink(kAboveJndColour));
  text_at(body, {corner.x, top + high + 1.0F}, ink(p.quiet), "0");
  text_at(body, {corner.x + width - 0.3F * line, top + high + 1.0F}, ink(p.quiet), "1");
  text_at(body, {corner.x + width + 1.0F * line, top + high + 1.0F}, ink(p.quiet), "error / JND");
}

}  // namespace palpate::overlay
