// Text and controls over the picture: title, verdict, labels, the big number with its colour scale, buttons, the bar of
// a replay, notices, dialogs.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <string>

#include "rendering/panels/dialogs.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/window_view.h"
#include "rendering/picture/block_view.h"

namespace palpate {

// The state of a recording; empty without one.
std::string recording_words(const RecordingStatus& recording);

// The part of the picture between the headline and the big number, for the blocks.
SceneArea stage_of(const LiveSession& session, const Verdict& verdict, const ViewState& view, const UiStyle& style,
                   const SceneArea& area);

void draw_overlay(LiveSession& session, const WindowView& shown, const BlockView& blocks, ViewState& view,
                  const UiStyle& style, const SceneArea& area, const OverlayActions& actions);

}  // namespace palpate
