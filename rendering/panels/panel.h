// The panel beside the 3-D view: curves, models, errors, the loop's health. Each part reads a view of window_view.h
// and draws at the cursor of the current ImGui window.
// Thread guarantee: the window's thread, inside a frame; functions that return text need no window.
#pragma once

#include "rendering/panels/panel_force.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

// The status line of the loop.
struct HealthWords {
  std::string text;
  bool problem = false;
  bool past = false;  // a past alarm that is not acknowledged (LiveSession::reset_figures)
};
// `recent_fps`: frames per second, of about the last 60 frames; 0: unknown. `details`: the reader is an engineer, to
// whom missed deadlines are a problem.
HealthWords health_words(const HealthView& health, double recent_fps, bool details);
// Age of the sample, rate, round trip, stiffness limit and heat of a real device, or of one with a fault; else empty.
std::string device_line(const HealthView& health);

// Draws an ImGui window at `area`.
void draw_panel(ForceCurves& curves, LiveSession& session, const WindowView& shown, ViewState& view,
                const UiStyle& style, const SceneArea& area);

}  // namespace palpate
