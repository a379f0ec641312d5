// A command of the window. Keys, buttons, tooltips and the list of keys come from one table of commands
// (rendering/app/demo_commands.cpp).
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
    pressed,   // once for each press
    repeated,  // also when the keyboard repeats the key
    held,      // in every frame while the key is held
  };
  std::vector<int> keys{};                 // of GLFW, any of them; empty: `shown` describes the input
  std::string shown{};                     // replaces the names of the keys in the list
  std::string label{};                     // of its button or menu item; empty: none
  std::string help{};                      // one line
  std::function<void(std::size_t)> run{};  // the argument is the index in `keys`; 0 for the button
  When when = When::pressed;
  bool control = false;        // with Ctrl
  bool bar = false;            // has a button; else, with a label, a menu item
  bool replay = false;         // available only during a replay; its button is in the bar of the replay
  std::function<bool()> on{};  // whether it is switched on, which its button shows
  std::string label_on{};      // label while it is switched on; empty: `label`
};

// A choice of several, as it is now. Its key takes the next one, the dialog View shows all.
struct WindowChoice {
  int key;  // of GLFW
  const char* title;
  const char* help;
  std::vector<std::string> names;        // those that are available
  std::size_t now;                       // index into `names`; the largest number: none of them
  std::function<void(std::size_t)> set;  // the argument is an index into `names`
  const char* why_none = "";             // a notice for the key where `names` is empty
};

// The name of a key of GLFW: "Space", "H"; empty where it is neither printable nor in the list of names.
std::string key_name(int key);
// The keys in the list and in tooltips: "Ctrl+Q", "H, /".
std::string shown_keys(const WindowCommand& command);
// The present label.
const std::string& shown_label(const WindowCommand& command);

// Draws the button with its tooltip at the cursor. Returns whether it was pressed.
bool command_button(const WindowCommand& command);

}  // namespace palpate
