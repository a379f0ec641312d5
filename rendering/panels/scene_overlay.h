// Text and controls over the picture: title, verdict, labels, the big number with its colour scale, buttons, the bar of
// a replay, notices, dialogs.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <imgui.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rendering/panels/layout.h"
#include "rendering/panels/view_state.h"
#include "rendering/panels/window_command.h"
#include "rendering/panels/window_view.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

// Callbacks of the dialogs.
struct OverlayActions {
  const std::vector<WindowCommand>* commands = nullptr;  // for the buttons and the list of keys
  std::function<void(const std::string&)> use_scene, open, use_device, use_line_up;
  std::function<void()> use_recording_roles;  // trains and tests by Dialogs::recording_roles
};

// Sentences of the overlay; may be empty.
std::string scale_words(const ForceScale& scale);
std::string data_warning(const ModelsView& models);
std::string recording_words(const RecordingStatus& recording);
// The big number and its description: the 99 % error of the active model in JND, over the same samples as the table;
// without a reference its predicted error; before the first model is ready the progress of its fit.
struct BigNumber {
  std::string number = "–";
  std::string what = "times the smallest difference a hand can feel:";
  std::string below = "the error of the active model";
  double error_over_jnd = 0.0;  // above 1 it is drawn in kAboveJndColour
};
BigNumber big_number(const ModelsView& models, bool has_truth);

// The instructions for a scene without models and material; else empty.
std::string empty_scene_words(const LiveSession& session);

void draw_overlay(LiveSession& session, const WindowView& shown, const BlockView& blocks, ViewState& view,
                  const UiStyle& style, const SceneArea& area, const std::vector<Toast>& toasts,
                  const OverlayActions& actions);

// Index in WindowView::blocks of the block nearest to `point`. `aimed`: empty unless the point is on or near it.
std::optional<std::size_t> block_at(const WindowView& shown, const BlockView& blocks, const SceneArea& area,
                                    const ImVec2& point, bool aimed);

}  // namespace palpate
