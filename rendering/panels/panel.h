// The panel beside the 3-D view: curves, models, errors, the loop's health. Each part reads a view of window_view.h
// and draws at the cursor of the current ImGui window.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/panel_force.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

// Draws an ImGui window at `area`.
void draw_panel(ForceCurves& curves, LiveSession& session, const WindowView& shown, ViewState& view,
                const UiStyle& style, const SceneArea& area);

}  // namespace palpate
