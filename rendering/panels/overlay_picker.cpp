// The dialog that opens files: the files of one folder, a path to type, and recent files. And the list of devices.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "rendering/panels/overlay_parts.h"
#include "rendering/panels/panel_parts.h"

namespace palpate::overlay {
namespace {

namespace fs = std::filesystem;

void go_to(FilePicker& picker, const fs::path& folder) {
  picker.folder = folder.string();
  picker.files = pickable_files(picker.folder);
  picker.takes_focus = true;
}

// Enters a folder, or opens a file. Returns whether `path` was a file.
bool pick(FilePicker& picker, const std::string& path, const OverlayActions& actions) {
  if (path.empty()) return false;
  std::error_code missing;
  if (fs::is_directory(path, missing)) {
    go_to(picker, path);
    return false;
  }
  actions.open(path);
  return true;
}

}  // namespace

std::vector<std::string> pickable_files(const std::string& folder) {
  std::vector<std::string> folders, files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::string ending = entry->path().extension().string();
    std::error_code unknown;
    if (name.front() == '.') continue;
    if (entry->is_directory(unknown)) {
      folders.push_back(name + "/");
    } else if (ending == ".json" || ending == ".csv" || ending == ".tsv" || ending == ".txt" || ending == ".dat") {
      files.push_back(name);
    }
  }
  std::sort(folders.begin(), folders.end());
  std::sort(files.begin(), files.end());
  folders.insert(folders.end(), files.begin(), files.end());
  return folders;
}

void draw_file_picker(ViewState& view, const OverlayActions& actions) {
  FilePicker& picker = view.dialogs.picker;
  if (!begin_dialog("Open a file", view.dialogs.file_list)) return picker.folder.clear();
  std::error_code error;
  if (picker.folder.empty()) go_to(picker, fs::current_path(error));
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float width = std::min(0.85F * all.x, 44.0F * ImGui::GetFontSize());
  bool done = false;
  ImGui::TextDisabled("A recording, another program's table, or a model (.json). A path, then Enter:");
  ImGui::SetNextItemWidth(width);
  if (std::exchange(picker.takes_focus, false)) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputText("##path", picker.path.data(), picker.path.size(),
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
    done = pick(picker, picker.path.data(), actions);
  for (const std::string& file : std::vector<std::string>(view.settings.recent))
    if (list_entry("recently opened: " + fs::path(file).filename().string() + "###" + file))
      done = pick(picker, file, actions);
  ImGui::TextUnformatted(fitting(picker.folder, width).c_str());
  tip(picker.folder.c_str());
  ImGui::BeginChild("files", {width, std::min(14.0F * line, 0.5F * all.y)}, true, ImGuiWindowFlags_NavFlattened);
  std::string chosen;
  if (list_entry("../")) chosen = fs::path(picker.folder).parent_path().string();
  for (const std::string& name : picker.files)
    if (list_entry(name)) chosen = (fs::path(picker.folder) / name).string();
  if (picker.files.empty()) ImGui::TextDisabled("nothing here that can be opened");
  ImGui::EndChild();
  ImGui::End();
  if (!chosen.empty())
    done = pick(picker, chosen.back() == '/' ? chosen.substr(0, chosen.size() - 1) : chosen, actions);
  if (done) view.dialogs.file_list = false;
}

// Draws the list of devices, with the reason if one cannot be used.
void draw_device_list(ViewState& view, const std::string& in_use, const OverlayActions& actions) {
  if (!begin_dialog("Device", view.dialogs.device_list)) return;
  if (view.dialogs.devices.empty()) ImGui::TextDisabled("looking for devices ...");
  for (const DeviceDescription& device : view.dialogs.devices) {
    const bool own = device.name == in_use;
    const bool usable = own || device.problem.empty();
    if (list_entry(device.name, own, usable)) {
      actions.use_device(device.name);
      view.dialogs.device_list = false;
    }
    ImGui::SameLine(8.0F * ImGui::GetFontSize());
    ImGui::PushTextWrapPos(40.0F * ImGui::GetFontSize());
    ImGui::TextDisabled("%s", own ? "in use here" : usable ? device.summary.c_str() : device.problem.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

}  // namespace palpate::overlay
