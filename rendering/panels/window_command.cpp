#include "rendering/panels/window_command.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

#include "rendering/panels/panel_parts.h"

namespace palpate {

constexpr std::pair<int, const char*> kKeyNames[] = {
    {GLFW_KEY_SPACE, "Space"},        {GLFW_KEY_HOME, "Home"},   {GLFW_KEY_BACKSPACE, "Backspace"},
    {GLFW_KEY_ESCAPE, "Esc"},         {GLFW_KEY_UP, "Up"},       {GLFW_KEY_DOWN, "Down"},
    {GLFW_KEY_LEFT, "Left"},          {GLFW_KEY_RIGHT, "Right"}, {GLFW_KEY_PAGE_UP, "Page Up"},
    {GLFW_KEY_PAGE_DOWN, "Page Down"}};

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

bool command_button(const WindowCommand& command) {
  const bool on = command.on && command.on();
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const bool pressed = ImGui::Button(shown_label(command).c_str());
  if (on) ImGui::PopStyleColor();
  tip((command.help + " (" + shown_keys(command) + ")").c_str());
  return pressed;
}

}  // namespace palpate
