// Text and controls over the picture: title, verdict, labels, the big number with its colour scale, buttons, the bar of
// a replay, notices; dialogs.cpp draws the commands' buttons and the dialogs in the middle of the window: help, files
// to open, devices, scenes, the view, roles of recordings.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rendering/panels/panel_parts.h"
#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/picture/block_view.h"
#include "scenes/live/live_session.h"

namespace palpate {

// A command of the window. Keys, buttons, tooltips and the list of keys come from one table of commands
// (rendering/app/demo_commands.cpp).
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

// The functions that buttons and dialogs call.
struct OverlayActions {
  const std::vector<WindowCommand>* commands = nullptr;  // for the buttons and the list of keys
  std::function<std::vector<WindowChoice>()> choices;    // of the dialog View
  std::function<void(const std::string&)> use_scene, open, use_device;
  std::function<void()> use_recording_roles;  // trains and tests as Dialogs::recording_roles says
};

// The state of a recording; empty without one.
std::string recording_words(const RecordingStatus& recording);

// The part of the picture between the headline and the big number, for the blocks.
SceneArea stage_of(const LiveSession& session, const Verdict& verdict, const ViewState& view, const UiStyle& style,
                   const SceneArea& area);

void draw_overlay(LiveSession& session, const WindowView& shown, const BlockView& blocks, ViewState& view,
                  const UiStyle& style, const SceneArea& area, const OverlayActions& actions);
void draw_dialogs(const LiveSession& session, ViewState& view, const OverlayActions& actions);

// The entries of a folder that can be opened: its folders ("name/"), then its files.
std::vector<std::string> pickable_files(const std::string& folder);

}  // namespace palpate
