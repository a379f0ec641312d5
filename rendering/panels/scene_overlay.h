// Text and controls over the picture: title, verdict, labels, the big number with its colour scale, buttons, the bar of
// a replay, notices; dialogs.cpp draws the dialogs in the middle of the window: help, files to open, devices, scenes,
// the view, roles of recordings.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rendering/panels/panel_parts.h"
#include "rendering/panels/view_state.h"
#include "rendering/panels/window_command.h"
#include "rendering/panels/window_view.h"
#include "rendering/picture/block_view.h"
#include "scenes/live/live_session.h"

namespace palpate {

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
