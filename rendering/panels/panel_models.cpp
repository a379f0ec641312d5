#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/text.h"
#include "rendering/panels/panel.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

using Slot = std::size_t;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double if_judged(const ModelView& model, double value) { return model.is_judged() ? value : kNone; }

// Forces are those of the last tick of the curves.
double error_now_N(const ModelsView& models, Slot slot) {
  if (std::isnan(models.now.difference_over_jnd(slot, models.jnd))) return kNone;
  return models.now.in_contact ? models.now.force_N[slot] - models.now.reference_N : 0.0;
}

std::string whole(double value) { return with_thousands(fixed(value, 0)); }
std::string two_decimals(double value) { return fixed(value, 2); }
std::string share(double percent) { return fixed(0.01 * std::floor(100.0 * percent), 2); }
std::string signed_mN(double value_N) {
  const std::string text = fixed(1e3 * value_N, 0);
  return text == "-0" ? "+0" : text.front() == '-' ? text : "+" + text;
}

struct Column {
  const char* heading;
  const char* tip;
  const char* widest;                                    // the widest text of the column
  int dropped;                                           // order of removal in a narrow panel, from 1; 0: never
  double (*value)(const ModelsView& models, Slot slot);  // NaN: none; null: the name
  std::string (*text)(double value);
};
constexpr int kName = 0, kErrorNow = 2, kP99 = 3, kColumns = 7, kDroppable = 4;
constexpr Column kTable[kColumns] = {
    {"model", "Click, or press its number: the active model. Shift and click: the two beside each other.",
     "      trend+greedy-100", 0, nullptr, nullptr},
    {"N", "Force at the right edge of the curves, newtons", "12.34", 3,
     [](const ModelsView& models, Slot slot) -> double { return models.now.force_N[slot]; }, two_decimals},
    {"error mN", "Model minus reference there, millinewtons", "+1234", 1, error_now_N, signed_mN},
    {"99 % error / JND",
     "99 % of the samples in contact are off by at most so many just noticeable differences (JND).\n"
     "Click: shows the moment of the largest error. The headline, the big number and the plot have this number.",
     "12.34", 0,
     [](const ModelsView& models, Slot slot) {
       return if_judged(models.slots[slot], models.slots[slot].errors.p99_error_over_jnd);
     },
     jnd_text},
    {"% in JND",
     "Share of the samples in contact within one JND, of the test that the line below names.\n"
     "With more centres it mostly grows, while the largest errors (99 %) may grow, too.",
     "100.00", 4,
     [](const ModelsView& models, Slot slot) {
       return if_judged(models.slots[slot], 100.0 * models.slots[slot].errors.within_jnd);
     },
     share},
    {"ns",
     "Time of a whole tick of this model alone (motion, features, force), nanoseconds: the median of six\n"
     "interleaved measurements. The report, the plot below and the headline have the same",
     "12,345", 0,
     [](const ModelsView& models, Slot slot) {
       return models.slots[slot].tick_ns() > 0.0 ? models.slots[slot].tick_ns() : kNone;
     },
     whole},
    {"centres", "Centres of the radial basis functions; nodes of a grid", "33,275", 2,
     [](const ModelsView& models, Slot slot) -> double { return models.slots[slot].centres; }, whole}};

// Sorts by magnitude; missing values come first.
std::vector<std::size_t> sorted_slots(const ModelsView& models, const TableState& sort) {
  std::vector<std::size_t> order = models.listed();
  if (sort.column < 0) return order;
  const auto magnitude = [&](Slot slot) {
    const double value = kTable[sort.column].value(models, slot);
    return std::isnan(value) ? -1.0 : std::abs(value);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (!sort.rising) std::swap(a, b);
    if (sort.column == kName) return models.slots[a].name < models.slots[b].name;
    return magnitude(a) < magnitude(b);
  });
  return order;
}

void right_aligned(const std::string& text, const Rgb& colour) {
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0F, room));
  ImGui::TextColored(paint(colour), "%s", text.c_str());
}

float cross_width() { return ImGui::CalcTextSize("×").x + 2.0F * ImGui::GetStyle().FramePadding.x; }

// Draws a heading, right-aligned except for the name. Clicks sort in one order, the other, and by slot.
void draw_heading(int column, TableState& sort) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float room = ImGui::GetContentRegionAvail().x;
  const float sign = 0.28F * ImGui::GetFontSize();
  const float width = ImGui::CalcTextSize(kTable[column].heading).x;
  ImGui::PushID(column);
  if (ImGui::InvisibleButton("sort", {std::max(room, 1.0F), ImGui::GetTextLineHeight() + sign})) {
    const bool rises_first = column == kName;
    const bool ends = sort.column == column && sort.rising != rises_first;
    sort.rising = (sort.column == column) != rises_first;
    sort.column = ends ? -1 : column;
  }
  ImGui::PopID();
  tip(kTable[column].tip);
  const ImU32 colour = ImGui::GetColorU32(ImGuiCol_Text);
  const float x = column == kName ? at.x : at.x + room - width;
  ImGui::GetWindowDrawList()->AddText({x, at.y + sign}, colour, kTable[column].heading);
  if (sort.column != column) return;
  // A small sign above the heading, which points up where the values rise.
  const float size = 0.5F * ImGui::GetFontSize();
  ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), size, {x + 0.5F * (width - size), at.y - 0.2F * size}, colour,
                                      sort.rising ? "▲" : "▼");
}

struct Rows {
  const WindowView& shown;
  ViewState& view;
  const UiStyle& style;
  const WindowActions& actions;

  const ModelsView& models() const { return shown.models; }

  void draw_menu(Slot slot) const {
    if (!models().slots[slot].other_material || !ImGui::BeginPopupContextItem()) return;
    if (ImGui::Selectable("It is a model of this material: compare it")) actions.models().treat_as_this_material(slot);
    ImGui::EndPopup();
  }

  // A model that is ready is taken out, the fit of another one is cancelled.
  void draw_cross(Slot slot) const {
    ImGui::PushID(static_cast<int>(slot));
    if (ImGui::SmallButton("×")) actions.models().remove(slot);
    ImGui::PopID();
    tip(models().slots[slot].state == SlotState::ready ? "takes it out of the comparison" : "cancels the fit");
  }

  void draw_name(Slot index) const {
    const ModelView& slot = models().slots[index];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), all = ImGui::GetContentRegionAvail().x;
    const ImU32 colour =
        ink(slot_colour(models(), index, style.theme()), slot.state == SlotState::ready ? 1.0F : 0.35F);
    const bool usable = slot.state == SlotState::ready, selected = index == models().selected;
    std::string name = slot.name;
    const float wide = ImGui::CalcTextSize(("      " + name).c_str()).x;
    const bool pointed = view.crossed == index, fits = wide + cross_width() <= all;
    const bool crossed = pointed || (selected && fits);
    // A name that is too long is cut at its number of centres; the last column and the tip have it.
    if (wide > all || (pointed && !fits)) name.erase(std::min(name.find('-'), name.size()));
    if (!slot.equals.empty()) name += "  (why?)";
    const std::string label = "      " + name + "###slot" + std::to_string(index);
    const auto flags = ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap |
                       (usable ? 0 : ImGuiSelectableFlags_Disabled);
    if (ImGui::Selectable(label.c_str(), selected || models().second == index, flags)) choose(index);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) view.pointed = index;
    draw_menu(index);
    tip(((selected ? slot.name + " is the active model"
                   : "Click, or press " + std::to_string(models().number_of(index)) + ", to make " + slot.name +
                         " the active model; Shift and click: these two beside each other") +
         equal_words(slot))
            .c_str());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 middle(at.x + 0.62F * line, at.y + 0.5F * line);
    if (selected) list.AddCircle(middle, 0.52F * line, ink(style.colours().text), 0, 1.5F);
    draw_mark(list, middle, (selected ? 0.40F : 0.27F) * line, slot.paper, colour, style);
    if (!crossed || !usable) return;
    ImGui::SameLine(all - cross_width());
    draw_cross(index);
  }

  void choose(Slot index) const {
    if (!ImGui::GetIO().KeyShift) return actions.select(index);
    view.second = index;
    view.settings.blocks = 2;
  }

  void draw_waiting(Slot index) const {
    const ModelView& slot = models().slots[index];
    // The first column that is shown.
    for (int column = kName + 1; column <= kP99 && !ImGui::TableSetColumnIndex(column);) ++column;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight();
    ImGui::PushClipRect(at, {at.x + 14.0F * line, at.y + 2.0F * line}, false);
    if (slot.state == SlotState::failed) {
      ImGui::TextDisabled("failed");
      tip(slot.problem.c_str());
    } else {
      const std::string words = slot.state == SlotState::waiting ? "waits" : fixed(100.0 * slot.progress, 0) + " %";
      // The words are beside the bar, which would cut them and hide them.
      ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0.0F});
      ImGui::ProgressBar(static_cast<float>(slot.progress), {4.0F * line, line}, "");
      ImGui::PopStyleVar();
      ImGui::SameLine();
      ImGui::TextUnformatted(words.c_str());
    }
    ImGui::SameLine();
    draw_cross(index);
    ImGui::PopClipRect();
  }

  // The last row: a list of methods, each with its sizes.
  void draw_plus() const {
    if (ImGui::Selectable("  +  add a model", false, ImGuiSelectableFlags_SpanAllColumns)) ImGui::OpenPopup("add");
    tip("Fits another model: a method and its number of centres");
    if (!ImGui::BeginPopup("add")) return;
    for (const MethodChoice& method : method_choices()) {
      ImGui::PushID(method.family.c_str());
      ImGui::AlignTextToFramePadding();
      ImGui::TextUnformatted(method.family.c_str());
      for (const int centres : method.centres) {
        const std::string size = centres > 0 ? std::to_string(centres) : "";
        ImGui::SameLine(centres == method.centres.front() ? 9.0F * ImGui::GetFontSize() : 0.0F);
        if (ImGui::Button(size.empty() ? "add" : size.c_str())) {
          actions.models().add(method.family + (size.empty() ? "" : "-") + size);
          ImGui::CloseCurrentPopup();
        }
      }
      ImGui::PopID();
    }
    ImGui::EndPopup();
  }

  // Draws the figures of a row. Hidden columns have no text; a number that is not known is a dash.
  void draw_figures(Slot index) const {
    for (int column = kName + 1; column < kColumns; ++column) {
      const Column& one = kTable[column];
      if (!ImGui::TableSetColumnIndex(column)) continue;
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const ImVec2 end(at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetTextLineHeight());
      const double value = models().slots[index].refitting ? kNone : one.value(models(), index);
      const Rgb colour = column == kP99 && value > 1.0 ? text_colour(kAboveJndColour, style.theme())
                         : column == kErrorNow         ? style.colours().quiet
                                                       : style.colours().text;
      right_aligned(std::isnan(value) ? "–" : one.text(value), colour);
      if (column == kP99 && ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(at, end) &&
          ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        actions.worst(index);
    }
  }
};

float column_width(const Column& column) {
  return std::max(ImGui::CalcTextSize(column.heading).x, ImGui::CalcTextSize(column.widest).x) +
         (column.value == nullptr ? cross_width() : 0.0F) + 2.0F * ImGui::GetStyle().CellPadding.x;
}

// How many columns have no room in a table that is `room` wide.
int columns_to_drop(float room) {
  int drops = 0;
  for (const Column& column : kTable) room -= column_width(column);
  while (room < 0.0F && drops < kDroppable) room += column_width(*std::ranges::find(kTable, ++drops, &Column::dropped));
  return drops;
}

}  // namespace

std::string equal_words(const ModelInfo& info) {
  if (info.equals.empty()) return {};
  return "\nThe same forces: " + joined(info.equals) +
         (info.method == "trend" ? ". Cross-validation takes no correction here, so that the trend is left." : ".");
}

void draw_model_table(const WindowView& window, ViewState& view, const UiStyle& style, float height,
                      const WindowActions& actions) {
  view.crossed = view.pointed;
  view.pointed = kReferenceBlock;
  const auto flags = ImGuiTableFlags_Hideable | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerH |
                     ImGuiTableFlags_NoSavedSettings;
  const int drops = columns_to_drop(ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize);
  if (!ImGui::BeginTable("models", kColumns, flags, {0.0F, height})) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (int column = 0; column < kColumns; ++column) {
    ImGui::TableSetupColumn(kTable[column].heading, ImGuiTableColumnFlags_WidthStretch, column_width(kTable[column]));
    ImGui::TableSetColumnEnabled(column, kTable[column].dropped == 0 || kTable[column].dropped > drops);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (int column = 0; column < kColumns; ++column)
    if (ImGui::TableSetColumnIndex(column)) draw_heading(column, view.table);
  const Rows rows{window, view, style, actions};
  for (const std::size_t index : sorted_slots(window.models, view.table)) {
    ImGui::TableNextRow();
    ImGui::TableSetColumnIndex(kName);
    rows.draw_name(index);
    if (window.models.slots[index].state == SlotState::ready) {
      rows.draw_figures(index);
    } else {
      rows.draw_waiting(index);
    }
  }
  if (window.scene->has_material()) {
    ImGui::TableNextRow();
    ImGui::TableSetColumnIndex(kName);
    rows.draw_plus();
  }
  ImGui::EndTable();
}

}  // namespace palpate
