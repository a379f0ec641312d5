#include "rendering/panels/panel_models.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "rendering/panels/panel_parts.h"
#include "rendering/ui/plot.h"

namespace palpate {
namespace {

enum Column : int { kName, kForce, kError, kRatio, kWithin, kTime, kCentres, kColumns };

struct Heading {
  const char* text;
  const char* tip;
  float share;
};
constexpr Heading kHeadings[kColumns] = {
    {"model", "Click, or press its number, to make a model the active one.", 2.5F},
    {"N", "Force now, newtons", 1.0F},
    {"mN off", "Error now: model minus reference, millinewtons", 1.25F},
    {"/JND", "Error now over the just noticeable difference; above 1 a hand could tell", 1.0F},
    {"% in JND", "Share of the samples in contact whose error a hand cannot tell, since the last reset",
     1.45F},
    {"ns", "Time of one evaluation, nanoseconds, median of the last second in contact", 1.1F},
    {"centres", "Centres of the radial basis functions; nodes of a grid", 1.35F}};

double sort_value(const SlotView& slot, int column) {
  switch (column) {
    case kForce:
      return slot.force_N;
    case kError:
      return std::abs(slot.error_N);
    case kRatio:
      return slot.error_over_jnd;
    case kWithin:
      return slot.errors.within_jnd();
    case kTime:
      return slot.evaluation_ns;
    case kCentres:
      return slot.centres;
    default:
      return 0.0;
  }
}

std::vector<std::size_t> sorted_slots(const ModelsView& models) {
  std::vector<std::size_t> order(models.slots.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs == nullptr || specs->SpecsCount == 0) return order;
  const int column = specs->Specs[0].ColumnIndex;
  const bool rising = specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (column == kName)
      return rising ? models.slots[a]->name < models.slots[b]->name
                    : models.slots[b]->name < models.slots[a]->name;
    const double left = sort_value(*models.slots[a], column);
    const double right = sort_value(*models.slots[b], column);
    return rising ? left < right : right < left;
  });
  return order;
}

void right_aligned(const std::string& text, const ImVec4* colour = nullptr) {
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0F, room));
  if (colour != nullptr) {
    ImGui::TextColored(*colour, "%s", text.c_str());
  } else {
    ImGui::TextUnformatted(text.c_str());
  }
}

// Over its numbers, which stand right; the header itself sorts.
void draw_heading(int column) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float room = ImGui::GetContentRegionAvail().x;
  const std::string id = "##" + std::string(kHeadings[column].text);
  ImGui::TableHeader(column == kName ? kHeadings[column].text : id.c_str());
  tip(kHeadings[column].tip);
  if (column == kName) return;
  const float width = ImGui::CalcTextSize(kHeadings[column].text).x;
  ImGui::GetWindowDrawList()->AddText({at.x + room - width, at.y}, ImGui::GetColorU32(ImGuiCol_Text),
                                      kHeadings[column].text);
}

std::string format(const char* pattern, double value) {
  char text[32];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

// "33,275"
std::string grouped(int count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

// Whether it was clicked.
bool draw_name(const ModelsView& models, std::size_t index, const UiStyle& style) {
  const SlotView& slot = *models.slots[index];
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  const ImU32 colour =
      ink(method_colour(slot.method, style.theme()), slot.state == SlotState::ready ? 1.0F : 0.35F);
  // Too long for the column: without the numbers, which the last one and the tip have.
  std::string name = slot.name;
  if (ImGui::CalcTextSize(("      " + name).c_str()).x > ImGui::GetContentRegionAvail().x)
    name.erase(std::min(name.find('-'), name.size()));
  const std::string label = "      " + name + "##slot" + std::to_string(index);
  const bool usable = slot.state == SlotState::ready;
  const auto flags = ImGuiSelectableFlags_SpanAllColumns | (usable ? 0 : ImGuiSelectableFlags_Disabled);
  const bool clicked = ImGui::Selectable(label.c_str(), index == models.selected, flags);
  tip(name_tip(models, index).c_str());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 middle(at.x + 0.62F * line, at.y + 0.5F * line);
  if (index == models.selected) {
    list.AddCircleFilled(middle, 0.40F * line, colour);
    list.AddCircle(middle, 0.52F * line, ink(style.colours().text), 0, 1.5F);
  } else {
    list.AddCircleFilled(middle, 0.27F * line, colour);
  }
  return clicked;
}

// Over the columns of the figures that are not there yet.
void draw_waiting(const SlotView& slot) {
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(at, {at.x + 12.0F * ImGui::GetFontSize(), at.y + 2.0F * ImGui::GetFontSize()}, false);
  ImGui::TextDisabled("%s", waiting_words(slot).c_str());
  if (slot.state == SlotState::failed) tip(slot.problem.c_str());
  ImGui::PopClipRect();
}

void draw_figures(const SlotView& slot, const UiStyle& style) {
  const ImVec4 above = paint(kAboveJndColour);
  const ImVec4 quiet = paint(style.colours().quiet);
  ImGui::TableNextColumn();
  right_aligned(format("%.2f", slot.force_N));
  ImGui::TableNextColumn();
  right_aligned(format("%+.0f", 1e3 * slot.error_N), &quiet);
  ImGui::TableNextColumn();
  right_aligned(format("%.2f", slot.error_over_jnd), slot.error_over_jnd > 1.0 ? &above : nullptr);
  ImGui::TableNextColumn();
  right_aligned(slot.errors.samples() > 0 ? format("%.2f", 100.0 * slot.errors.within_jnd()) : "–");
  ImGui::TableNextColumn();
  right_aligned(slot.evaluation_ns > 0.0 ? grouped(static_cast<int>(slot.evaluation_ns)) : "–");
  ImGui::TableNextColumn();
  right_aligned(grouped(slot.centres));
}

}  // namespace

std::string waiting_words(const SlotView& slot) {
  if (slot.state == SlotState::waiting) return "waits";
  return slot.state == SlotState::fitting ? format("fits %.0f %%", 100.0 * slot.progress) : "failed";
}

std::string name_tip(const ModelsView& models, std::size_t slot) {
  const std::string& name = models.slots[slot]->name;
  if (slot == models.selected) return name + " is the active model";
  return "Click, or press " + std::to_string(slot + 1) + ", to make " + name + " the active model";
}

std::optional<std::size_t> draw_model_table(const ModelsView& models, const UiStyle& style, float height) {
  const auto flags = ImGuiTableFlags_Sortable | ImGuiTableFlags_SortTristate | ImGuiTableFlags_ScrollY |
                     ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_NoSavedSettings;
  if (!ImGui::BeginTable("models", kColumns, flags, {0.0F, height})) return std::nullopt;
  std::optional<std::size_t> clicked;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const Heading& heading : kHeadings)
    ImGui::TableSetupColumn(heading.text, ImGuiTableColumnFlags_WidthStretch, heading.share);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (int column = 0; column < kColumns; ++column) {
    ImGui::TableSetColumnIndex(column);
    draw_heading(column);
  }
  for (const std::size_t index : sorted_slots(models)) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (draw_name(models, index, style)) clicked = index;
    if (models.slots[index]->state == SlotState::ready) {
      draw_figures(*models.slots[index], style);
    } else {
      draw_waiting(*models.slots[index]);
    }
  }
  ImGui::EndTable();
  return clicked;
}

}  // namespace palpate
