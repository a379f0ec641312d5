// Words and controls over the picture: title, number of blocks, labels, the big
// number with its colour scale, buttons, a replay's bar, notices, help.
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

// What the windows over the picture can ask of the program.
struct OverlayActions {
  const std::vector<WindowCommand>* commands = nullptr;  // buttons and the list of keys
  std::function<void(const std::string&)> use_scene, open, use_device, use_line_up;
  std::function<void()> start_offer;  // train and test as the offer says
};

// The overlay's sentences; empty when there is nothing to tell.
std::string scale_words(const ForceScale& scale);
std::string data_warning(const ModelsView& models);
std::string recording_words(const RecordingStatus& recording);
// The big number and what it is: the 99 % error of the active model in JND, over the
// samples that the table is of; without a reference the one it predicts; how far the first
// fit is before there is one.
struct BigNumber {
  std::string number = "–";
  std::string what = "times the smallest difference a hand can feel:";
  std::string below = "the error of the active model";
  double error_over_jnd = 0.0;  // above 1 in its own colour
};
BigNumber big_number(const ModelsView& models, bool has_truth);

// What a scene without models and without a material says of itself; empty otherwise.
std::string empty_scene_words(const LiveSession& session);

class SceneOverlay {
 public:
  // Controls call `actions`.
  void draw(LiveSession& session, const WindowView& shown, const BlockView& blocks, ViewState& view,
            const UiStyle& style, const SceneArea& area, const std::vector<Toast>& toasts,
            const OverlayActions& actions);

 private:
  float buttons_height_ = 0.0F;  // in the last frame
};

// The place on the stage of the block that is at `point`, or that is nearest to it; nothing: there is none
// (`aimed`: nor one so near that it is meant).
std::optional<std::size_t> block_at(const WindowView& shown, const BlockView& blocks, const SceneArea& area,
                                    const ImVec2& point, bool aimed);

}  // namespace palpate
