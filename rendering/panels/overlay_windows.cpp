// Windows and notices over the picture: the keys, files, scenes, roles of recordings, requests of the device.
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>

#include "rendering/panels/overlay_parts.h"
#include "rendering/panels/panel_parts.h"
#include "scenes/scene/folders.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/slot_plan.h"

namespace palpate::overlay {
namespace {

constexpr const char* kPictureHelp[] = {
    "The probe presses the same block with several models at once; the sentence at the top says which one to take.",
    "JND: the smallest difference of force that a hand can feel, 0.065 N plus 6 % of the force. Grey band: one JND to "
    "either side of the reference. A hand cannot feel the difference between the reference and a curve in the band.",
    "Green: the reference, the true or the recorded force. Other colours: one for each method; hollow marks: the "
    "recipe of 2009. On a dent: its error, from light (0) to green (1 JND); magenta is above.",
    "Centres: the points that a radial basis function model is made of. More centres make it more accurate and "
    "slower."};

}  // namespace

void draw_plate(ImDrawList& list, const ImVec2& at, const ImVec2& size, const ImVec2& margin, ImU32 colour,
                std::optional<Rgb> stripe) {
  const ImVec2 low(at.x - margin.x, at.y - margin.y), high(at.x + size.x + margin.x, at.y + size.y + margin.y);
  list.AddRectFilled(low, high, colour, 6.0F);
  if (stripe) list.AddRectFilled(low, {at.x - 0.55F * margin.x, high.y}, ink(*stripe), 3.0F);
}

bool begin_dialog(const char* title, bool& open) {
  if (!open) return false;
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float margin = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5F * all.x, 0.5F * all.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {all.x - margin, all.y - margin});
  ImGui::Begin(title, &open,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoMove);
  if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
  return true;
}

bool enter_pressed() { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false); }

bool list_entry(const std::string& text, bool selected, bool enabled) {
  const bool chosen = ImGui::Selectable(text.c_str(), selected, enabled ? 0 : ImGuiSelectableFlags_Disabled);
  if (selected) ImGui::SetItemDefaultFocus();
  return chosen || (enabled && ImGui::IsItemFocused() && enter_pressed());
}

void draw_toasts(const std::vector<Toast>& toasts, const UiStyle& style, const SceneArea& area, float top_px) {
  float y = top_px;
  ImFont* font = style.fonts().body;
  const float pad = 0.6F * height_of(font);
  const float wrap = 0.86F * area.size.x;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Toast& toast : toasts) {
    const ImVec2 size = font->CalcTextSizeA(height_of(font), 1e6F, wrap, toast.text.c_str());
    const float x = area.at.x + 0.5F * (area.size.x - size.x);
    draw_plate(list, {x, y}, size, {pad, pad}, ink(style.colours().raised),
               toast.problem ? style.colours().fault : reference_colour(style.theme()));
    list.AddText(font, height_of(font), {x, y}, ink(style.colours().text), toast.text.c_str(), nullptr, wrap);
    y += size.y + 2.6F * pad;
  }
}

void draw_data_warning(const ModelsView& models, const UiStyle& style, const SceneArea& area, float top_px) {
  const std::string text = data_warning(models);
  if (text.empty()) return;
  const float wrap = 0.8F * area.size.x;
  const ImVec2 size = text_size(style.fonts().body, text, wrap);
  const float pad = 0.4F * height_of(style.fonts().body);
  const ImVec2 at(area.at.x + 0.5F * (area.size.x - size.x), top_px + pad);
  draw_plate(*ImGui::GetBackgroundDrawList(), at, size, {2.0F * pad, pad}, ink(style.colours().raised));
  text_at(style.fonts().body, at, ink(style.colours().text), text, wrap);
}

// Draws the request of the device to its user, in large text in the middle.
void draw_device_words(LiveSession& session, const UiStyle& style, const SceneArea& area) {
  std::string words = empty_scene_words(session);
  if (words.empty()) words = session.device_words();
  if (words.empty()) return;
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  ImGui::SetNextWindowPos({area.at.x + 0.5F * area.size.x, area.at.y + 0.32F * area.size.y}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSize({0.8F * area.size.x, 0.0F});
  ImGui::Begin("device", nullptr, kFloating & ~ImGuiWindowFlags_NoBackground);
  ImGui::PushFont(style.fonts().heading);
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopFont();
  if (session.newest().device.zeroing == Zeroing::needed && ImGui::Button("Zero here (Z)")) session.start_zeroing();
  ImGui::End();
}

void draw_help(ViewState& view, const UiStyle& style, const std::vector<WindowCommand>& commands) {
  if (!begin_dialog("Help", view.dialogs.help)) return;
  float keys = 0.0F;
  float text = 0.0F;
  for (const WindowCommand& command : commands) {
    keys = std::max(keys, ImGui::CalcTextSize(shown_keys(command).c_str()).x);
    text = std::max(text, ImGui::CalcTextSize(command.help.c_str()).x);
  }
  ImGui::PushTextWrapPos(0.9F * ImGui::GetIO().DisplaySize.x);
  for (const char* sentence : kPictureHelp) ImGui::TextWrapped("%s", sentence);
  ImGui::PopTextWrapPos();
  ImGui::Separator();
  // Two columns if one is too high for the window.
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float high = (static_cast<float>(commands.size()) + 11.0F) * ImGui::GetTextLineHeightWithSpacing();
  const std::size_t columns = high > all.y ? 2 : 1;
  const float room =
      (all.x - 4.0F * ImGui::GetFontSize()) / static_cast<float>(columns) - keys - 2.0F * ImGui::GetFontSize();
  const std::size_t rows = (commands.size() + columns - 1) / columns;
  if (ImGui::BeginTable("keys", 2 * static_cast<int>(columns), ImGuiTableFlags_NoSavedSettings)) {
    for (std::size_t column = 0; column < columns; ++column) {
      ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, keys + 0.5F * ImGui::GetFontSize());
      ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, std::min(text, room));
    }
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = row; i < commands.size(); i += rows) {
        ImGui::TableNextColumn();
        ImGui::TextColored(paint(style.colours().text), "%s", shown_keys(commands[i]).c_str());
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", commands[i].help.c_str());
      }
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_scene_list(const LiveSession& session, ViewState& view, const OverlayActions& actions) {
  if (!begin_dialog("Scenes", view.dialogs.scene_list)) return;
  const auto names = scene_names();
  for (const std::string& name : names ? *names : std::vector<std::string>{}) {
    const auto scene = load_scene(name);
    // The scene of the study has no block.
    if (!scene || name == "jnd_study") continue;
    if (list_entry(scene->title + "###" + name, name == session.scene().name)) {
      view.dialogs.scene_list = false;
      actions.use_scene(name);
    }
    tip(scene->description.c_str());
  }
  ImGui::End();
}

namespace {

// Draws a choice of several. Returns the index that the user has just chosen.
template <typename Names>
std::optional<std::size_t> choose(const char* title, const Names& names, std::size_t now) {
  std::optional<std::size_t> chosen;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(title);
  for (std::size_t i = 0; i < std::size(names); ++i) {
    ImGui::SameLine(i == 0 ? 8.0F * ImGui::GetFontSize() : 0.0F);
    ImGui::PushID(title);
    if (ImGui::RadioButton(names[i], i == now)) chosen = i;
    ImGui::PopID();
  }
  return chosen;
}

// Draws a choice of two.
void choose(const char* title, const char* yes, const char* no, bool& value) {
  if (const auto to = choose(title, std::array{yes, no}, value ? 0 : 1)) value = *to == 0;
}

}  // namespace

void draw_view_list(LiveSession& session, ViewState& view, const OverlayActions& actions) {
  if (!begin_dialog("View", view.dialogs.view_list)) return;
  const std::size_t blocks = view.settings.block_count;
  if (const auto to = choose("Blocks (B)", std::array{"1", "2", "4"}, blocks == 4 ? 2 : blocks - 1))
    view.settings.block_count = std::size_t{1} << *to;
  std::vector<const char*> line_up_names;
  std::size_t line_up = static_cast<std::size_t>(-1);
  for (const LineUp& one : line_ups()) {
    if (session.line_up() == one.name) line_up = line_up_names.size();
    line_up_names.push_back(one.name);
  }
  if (session.scene().has_material()) {
    if (const auto to = choose("Models (N)", line_up_names, line_up)) actions.use_line_up(line_ups()[*to].name);
  }
  std::vector<const char*> reference_names;
  std::vector<ReferenceKind> kinds;
  std::size_t reference = static_cast<std::size_t>(-1);
  for (const ReferenceKind kind : kReferenceKinds) {
    if (!session.has_reference(kind)) continue;
    if (kind == session.comparison().reference()) reference = kinds.size();
    kinds.push_back(kind);
    reference_names.push_back(kind == ReferenceKind::measured ? "measured force"
                              : kind == ReferenceKind::truth  ? "true force"
                                                              : "a model: all sites");
  }
  if (const auto to = choose("Compare with (F)", reference_names, reference)) session.use_reference(kinds[*to]);
  choose("Curves (V)", "difference", "mean over 50 ms", view.settings.difference);
  choose("Plot (E)", "error against time", "error against force", view.verdict);
  if (const auto to = choose("Theme (T)", std::array{"light", "dark"}, view.settings.theme == Theme::light ? 0 : 1))
    view.settings.theme = *to == 0 ? Theme::light : Theme::dark;
  if (session.renders_force()) {
    const auto now = static_cast<std::size_t>(session.dead_man());
    if (const auto to = choose("Push only while (D)", std::array{"always", "G is held", "the grip is held"}, now))
      session.use_dead_man(static_cast<DeadMan>(*to));
  }
  ImGui::Checkbox("Arrows show ten times the difference (X)", &view.exaggerated);
  ImGui::Checkbox("All figures of the loop, and its faults (L)", &view.details);
  ImGui::SetNextItemWidth(10.0F * ImGui::GetFontSize());
  ImGui::SliderFloat("text size (+, -)", &view.settings.text_size, kSmallestText, kLargestText, "%.1f");
  ImGui::End();
}

namespace {

void draw_role(RecordingRoles& roles, std::size_t index) {
  using Role = OpenedRecording::Role;
  OpenedRecording& one = roles.recordings[index];
  ImGui::PushID(static_cast<int>(index));
  if (ImGui::RadioButton("train", one.role == Role::train)) one.role = Role::train;
  tip("Models are fitted to it; several are one training set");
  ImGui::SameLine();
  if (ImGui::RadioButton("test", one.role == Role::test)) roles.make_test(index);
  tip("It is replayed, and the models are judged on it; none is fitted to it");
  ImGui::SameLine();
  if (ImGui::RadioButton("leave", one.role == Role::none)) one.role = Role::none;
  ImGui::PopID();
  ImGui::SameLine();
  ImGui::TextUnformatted(std::filesystem::path(one.path).filename().c_str());
  tip(one.path.c_str());
  for (const std::string& line : one.words) ImGui::TextDisabled("%s", line.c_str());
}

// Describes the effect of the button Start.
std::string recording_roles_words(const RecordingRoles& roles) {
  const std::size_t training = roles.training().size();
  const bool test = !roles.test().empty();
  if (training == 0 && !test) return "Choose a recording to train on, or one to test on.";
  if (training == 0) return "Tests the models that are here on it. None is fitted again.";
  const std::string fits =
      "Fits models to " + std::to_string(training) + (training == 1 ? " recording" : " recordings");
  return fits +
         (test ? ", and tests them on the other." : "; you press the best one. Drop a second recording to test on.");
}

}  // namespace

void draw_recording_roles(ViewState& view, const OverlayActions& actions) {
  RecordingRoles& roles = view.dialogs.recording_roles;
  bool open = roles.any();
  if (!begin_dialog(roles.problem.empty() ? "Recordings" : "Not a recording", open)) return;
  ImGui::PushTextWrapPos(std::min(0.8F * ImGui::GetIO().DisplaySize.x, 42.0F * ImGui::GetFontSize()));
  if (!roles.problem.empty()) {
    ImGui::TextUnformatted(roles.problem.c_str());
    ImGui::TextDisabled(
        "What it asks for is an option of `palpate import FILE --out REC.csv`; drop that recording here.");
    if (roles.recordings.empty() && (ImGui::Button("OK (Enter)") || enter_pressed())) open = false;
  }
  for (std::size_t i = 0; i < roles.recordings.size(); ++i) draw_role(roles, i);
  if (!roles.recordings.empty()) {
    ImGui::TextUnformatted(recording_roles_words(roles).c_str());
    const bool ready = !roles.training().empty() || !roles.test().empty();
    if ((ImGui::Button("Start (Enter)") || (!ImGui::GetIO().WantTextInput && enter_pressed())) && ready) {
      actions.use_recording_roles();
      open = false;
    }
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
  if (!open) roles = {};
}

}  // namespace palpate::overlay
