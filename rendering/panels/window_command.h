// What the window can be asked for. One table of these rows (rendering/app/
// demo_commands.cpp) is where keys, buttons, tooltips and the list of keys come from.
// Thread guarantee: values of the window's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

struct WindowCommand {
  enum class When : std::uint8_t {
    pressed,   // once
    repeated,  // and again as long as the keyboard repeats it
    held,      // in every frame
  };
  std::vector<int> keys{};                 // GLFW's, any of them; none: `shown` says what does it
  std::string shown{};                     // in the list, in place of the keys' own names
  std::string label{};                     // of its button or its row in the menu; empty: none
  std::string help{};                      // one line
  std::function<void(std::size_t)> run{};  // which of the keys; 0 for the button
  When when = When::pressed;
  bool control = false;        // together with Ctrl
  bool bar = false;            // a button of its own; else, with a label, a row of the menu
  bool replay = false;         // only while a recording is replayed, with the button in its bar
  std::function<bool()> on{};  // whether it is in force, which its button shows
  std::string label_on{};      // then, where it is another
};

// "Space", "H": the name of a key of GLFW that stands in the table.
std::string key_name(int key);
// How the list of keys and tooltips call it: "Ctrl+Q", "H, /".
std::string shown_keys(const WindowCommand& command);
// The button's text as it is now.
const std::string& shown_label(const WindowCommand& command);

// Its button with its tooltip, at the cursor; whether it was pressed.
bool command_button(const WindowCommand& command);

}  // namespace palpate
