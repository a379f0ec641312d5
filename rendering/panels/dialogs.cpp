#include <GLFW/glfw3.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "rendering/panels/panel.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPictureHelp[] = {
    "The probe presses the same block with several models at once; the sentence at the top says which one to take.",
    kBestRule,
    kJndDefinition,
    "Grey band: one JND to either side of the reference.",
    ("Green: the truth, a true or recorded force. Other colours: one for each method; hollow marks: the paper of 2009. "
     "In the cut of a block: the error of this press, from white (0) over yellow to dark red (1 JND), violet with a "
     "ring above; the arrows are the forces of the model and, narrow, of the truth."),
    ("Centres: the points that a radial basis function model is made of. More centres cost time. They mostly bring "
     "more of a press within the JND (the column % in JND), but the largest errors (99 %) may grow.")};

constexpr std::pair<int, const char*> kKeyNames[] = {
    {GLFW_KEY_SPACE, "Space"},   {GLFW_KEY_HOME, "Home"},   {GLFW_KEY_BACKSPACE, "Backspace"},
    {GLFW_KEY_ESCAPE, "Esc"},    {GLFW_KEY_UP, "Up"},       {GLFW_KEY_DOWN, "Down"},
    {GLFW_KEY_LEFT, "Left"},     {GLFW_KEY_RIGHT, "Right"}, {GLFW_KEY_PAGE_UP, "PgUp"},
    {GLFW_KEY_PAGE_DOWN, "PgDn"}};

// The room of a dialog: the width of the picture, so that the panel stays visible beside it.
ImVec2 dialog_room() { return {lay_out(ImGui::GetIO().DisplaySize).scene.size.x, ImGui::GetIO().DisplaySize.y}; }

// Begins a dialog in the middle of its room. Call ImGui::End afterwards.
void begin_dialog(const char* title, bool& open) {
  const ImVec2 all = dialog_room();
  const float margin = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5F * all.x, 0.5F * all.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {all.x - margin, all.y - margin});
  ImGui::Begin(title, &open,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoMove);
  if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
}

// Begins it if it is open. Call ImGui::End if this returns true.
bool begin_dialog(const char* title, Dialogs& dialogs, Dialog one) {
  bool open = dialogs.open == one;
  if (!open) return false;
  begin_dialog(title, open);
  if (!open) dialogs.open = Dialog::none;
  return true;
}

bool enter_pressed() { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false); }

// An entry of a list. Returns whether it was chosen with the mouse, the space bar or Enter.
bool list_entry(const std::string& text, bool selected = false, bool enabled = true) {
  const bool chosen = ImGui::Selectable(text.c_str(), selected, enabled ? 0 : ImGuiSelectableFlags_Disabled);
  if (selected) ImGui::SetItemDefaultFocus();
  return chosen || (enabled && ImGui::IsItemFocused() && enter_pressed());
}

void draw_help(ViewState& view, const std::vector<WindowCommand>& commands) {
  if (!begin_dialog("Help", view.dialogs, Dialog::help)) return;
  const float unit = ImGui::GetFontSize(), all = dialog_room().x - 4.0F * unit;
  const int columns = all > 45.0F * unit ? 2 : 1;
  float keys = 0.0F;
  for (const WindowCommand& command : commands)
    keys = std::max(keys, ImGui::CalcTextSize(shown_keys(command).c_str()).x + unit);
  for (const char* sentence : kPictureHelp) ImGui::TextUnformatted(in_lines(sentence, all).c_str());
  ImGui::Separator();
  if (ImGui::BeginTable("keys", columns)) {
    for (const WindowCommand& command : commands) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(shown_keys(command).c_str());
      ImGui::SameLine(keys);
      ImGui::TextUnformatted(in_lines(command.help, all / static_cast<float>(columns) - keys - unit).c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

// The scenes with a material, in the order of what they show.
void draw_scene_list(const WindowView& shown, ViewState& view, const WindowActions& actions) {
  if (!begin_dialog("Scenes", view.dialogs, Dialog::scenes)) return;
  static const std::vector<Scene> scenes = [] {
    std::vector<Scene> all;
    const auto names = scene_names();
    for (const std::string& name : names ? *names : std::vector<std::string>{})
      if (auto scene = load_scene(name); scene && scene->material && scene->order > 0) all.push_back(std::move(*scene));
    std::ranges::stable_sort(all, {}, &Scene::order);
    return all;
  }();
  for (const Scene& scene : scenes) {
    if (list_entry(scene.title + "###" + scene.name, scene.name == shown.scene->name)) {
      view.dialogs.open = Dialog::none;
      actions.use_scene(scene.name);
    }
    tip(scene.description.c_str());
    ImGui::SameLine(11.0F * ImGui::GetFontSize());
    ImGui::TextDisabled("%s", scene.shows.c_str());
  }
  ImGui::End();
}

void draw_export_list(ViewState& view, const WindowActions& actions) {
  if (!begin_dialog("Export", view.dialogs, Dialog::exports)) return;
  for (const auto& one : actions.exports) {
    if (!list_entry(one.first, &one == &actions.exports.front())) continue;
    view.dialogs.open = Dialog::none;
    one.second();
  }
  ImGui::End();
}

void draw_view_list(ViewState& view, const WindowActions& actions) {
  if (!begin_dialog("View", view.dialogs, Dialog::view)) return;
  for (const WindowChoice& choice : actions.choices()) {
    if (choice.names.empty()) continue;
    ImGui::PushID(choice.key);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted((choice.title + (" (" + key_name(choice.key) + ")")).c_str());
    for (std::size_t i = 0; i < choice.names.size(); ++i) {
      ImGui::SameLine(i == 0 ? 8.0F * ImGui::GetFontSize() : 0.0F);
      if (ImGui::RadioButton(choice.names[i].c_str(), i == choice.now)) choice.set(i);
    }
    ImGui::PopID();
  }
  ImGui::SetNextItemWidth(10.0F * ImGui::GetFontSize());
  ImGui::SliderFloat("text size (+, -)", &view.settings.text_size, kSmallestText, kLargestText, "%.1f");
  ImGui::End();
}

// Returns whether the user takes the recording out of the list.
bool draw_role(RecordingRoles& roles, const ConvertedRecording& one) {
  ImGui::PushID(one.path.c_str());
  const bool test = roles.tested == one.path;
  if (ImGui::RadioButton("train", !test) && test) roles.tested.clear();
  tip("Models are fitted to it; several are one training set");
  ImGui::SameLine();
  if (ImGui::RadioButton("test", test)) roles.tested = one.path;
  tip("It is replayed, and the models are judged on it; none is fitted to it");
  ImGui::SameLine();
  const bool out = ImGui::SmallButton("leave");
  if (out && test) roles.tested.clear();
  tip("It is neither: takes it out of this list");
  ImGui::PopID();
  ImGui::SameLine();
  ImGui::TextUnformatted(fs::path(one.path).filename().c_str());
  tip(one.path.c_str());
  for (const std::string& line : one.words) ImGui::TextDisabled("%s", line.c_str());
  return out;
}

std::string recording_roles_words(const RecordingRoles& roles) {
  const std::size_t training = roles.training().size();
  if (training == 0) return "Tests the models that are here on it. None is fitted again.";
  return "Fits models to " + std::to_string(training) + (training == 1 ? " recording" : " recordings") +
         (roles.tested.empty() ? " without the end, and tests them on that. Drop a second recording to test on it."
                               : ", and tests them on the other.");
}

void draw_recording_roles(ViewState& view, const WindowActions& actions) {
  RecordingRoles& roles = view.dialogs.recording_roles;
  if (!roles.any()) return;
  bool open = true;
  begin_dialog(roles.problem.empty() ? "Recordings" : "Not a recording", open);
  ImGui::PushTextWrapPos(std::min(0.8F * dialog_room().x, 42.0F * ImGui::GetFontSize()));
  if (!roles.problem.empty()) {
    ImGui::TextUnformatted(roles.problem.c_str());
    ImGui::TextDisabled(
        "What it asks for is an option of `palpate import FILE --out REC.csv`; drop that recording here.");
    if (roles.recordings.empty() && (ImGui::Button("OK (Enter)") || enter_pressed())) open = false;
  }
  std::erase_if(roles.recordings, [&](const ConvertedRecording& one) { return draw_role(roles, one); });
  if (!roles.recordings.empty()) {
    ImGui::TextUnformatted(recording_roles_words(roles).c_str());
    if (ImGui::Button("Start (Enter)") || (!ImGui::GetIO().WantTextInput && enter_pressed())) {
      actions.use_recording_roles();
      open = false;
    }
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
  if (!open) roles = {};
}

// Enters a folder, or opens a file. Returns whether `path` was a file.
bool pick(FilePicker& picker, const fs::path& path, const WindowActions& actions) {
  std::error_code missing;
  if (!fs::is_directory(path, missing)) {
    if (!path.empty()) actions.open(path.string());
    return !path.empty();
  }
  picker.folder = path.string();
  picker.files = pickable_files(picker.folder);
  picker.takes_focus = true;
  return false;
}

void draw_file_picker(ViewState& view, const WindowActions& actions) {
  FilePicker& picker = view.dialogs.picker;
  if (!begin_dialog("Open a file", view.dialogs, Dialog::files)) return picker.folder.clear();
  std::error_code error;
  if (picker.folder.empty()) (void)pick(picker, fs::current_path(error), actions);
  const ImVec2 all = dialog_room();
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float width = std::min(0.85F * all.x, 44.0F * ImGui::GetFontSize());
  std::optional<fs::path> chosen;
  ImGui::TextDisabled("A recording, another program's table, or a model (.json). A path, then Enter:");
  ImGui::SetNextItemWidth(width);
  if (std::exchange(picker.takes_focus, false)) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputText("##path", picker.path.data(), picker.path.size(),
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
    chosen = picker.path.data();
  for (const std::string& file : view.settings.recent)
    if (list_entry("recently opened: " + fs::path(file).filename().string() + "###" + file)) chosen = file;
  ImGui::TextUnformatted(fitting(picker.folder, width).c_str());
  tip(picker.folder.c_str());
  ImGui::BeginChild("files", {width, std::min(14.0F * line, 0.5F * all.y)}, true, ImGuiWindowFlags_NavFlattened);
  if (list_entry("../")) chosen = fs::path(picker.folder).parent_path();
  for (const std::string& name : picker.files)
    if (list_entry(name)) chosen = fs::path(picker.folder) / name.substr(0, name.find('/'));
  if (picker.files.empty()) ImGui::TextDisabled("nothing here that can be opened");
  ImGui::EndChild();
  ImGui::End();
  if (chosen && pick(picker, *chosen, actions)) view.dialogs.open = Dialog::none;
}

void draw_device_list(ViewState& view, const std::string& in_use, const WindowActions& actions) {
  if (!begin_dialog("Device", view.dialogs, Dialog::devices)) return;
  if (ImGui::IsWindowAppearing()) actions.look_for_devices();
  if (view.devices.empty()) ImGui::TextDisabled("looking for devices ...");
  for (const DeviceDescription& device : view.devices) {
    const bool own = device.name == in_use;
    const bool usable = own || device.problem.empty();
    if (list_entry(device.name, own, usable)) {
      actions.use_device(device.name);
      view.dialogs.open = Dialog::none;
    }
    ImGui::SameLine(8.0F * ImGui::GetFontSize());
    ImGui::PushTextWrapPos(40.0F * ImGui::GetFontSize());
    ImGui::TextDisabled("%s", own ? "in use here" : usable ? device.summary.c_str() : device.problem.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

}  // namespace

std::string key_name(int key) {
  for (const auto& [known, name] : kKeyNames)
    if (known == key) return name;
  // GLFW numbers printable keys by their ASCII characters. The other keys have numbers from 256 on.
  if (key < GLFW_KEY_SPACE || key > GLFW_KEY_GRAVE_ACCENT) return {};
  return {static_cast<char>(key)};
}

std::string shown_keys(const WindowCommand& command) {
  if (!command.shown.empty()) return command.shown;
  std::string text;
  for (const int key : command.keys) text.append(text.empty() ? "" : ", ").append(key_name(key));
  return command.control ? std::string("Ctrl+").append(text) : text;
}

const std::string& shown_label(const WindowCommand& command) {
  const bool other = command.on && !command.label_on.empty() && command.on();
  return other ? command.label_on : command.label;
}

bool command_button(const WindowCommand& command, float side) {
  const bool on = command.on && command.on();
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const std::string& label = shown_label(command);
  const float width = ImGui::CalcTextSize(label.c_str()).x + 2.0F * ImGui::GetStyle().FramePadding.x;
  const bool pressed = ImGui::Button(label.c_str(), {std::max(side, width), side});
  if (on) ImGui::PopStyleColor();
  tip((command.help + " (" + shown_keys(command) + ")").c_str());
  return pressed;
}

std::vector<std::string> pickable_files(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string(), ending = entry->path().extension().string();
    std::error_code unknown;
    if (name.front() == '.') continue;
    if (entry->is_directory(unknown)) {
      names.push_back(name + "/");
    } else if (ending == ".json" || ending == ".csv" || ending == ".tsv" || ending == ".txt" || ending == ".dat") {
      names.push_back(name);
    }
  }
  std::ranges::sort(names, {}, [](const std::string& name) { return std::pair(name.back() != '/', name); });
  return names;
}

void draw_dialogs(const WindowView& shown, ViewState& view, const WindowActions& actions) {
  draw_file_picker(view, actions);
  draw_device_list(view, shown.health.device_name, actions);
  draw_scene_list(shown, view, actions);
  draw_view_list(view, actions);
  draw_export_list(view, actions);
  draw_recording_roles(view, actions);
  draw_help(view, *actions.commands);
}

}  // namespace palpate
