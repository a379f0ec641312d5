// The lowest part of the panel: the state of the loop and the device.
// Thread guarantee: the window's thread, inside a frame; functions that return text need no window.
#pragma once

#include <string>

#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// The status line of the loop.
struct HealthWords {
  std::string text;
  bool problem = false;
  bool past = false;  // a past alarm that is not acknowledged (LiveSession::reset_figures)
};
// `recent_fps`: frames per second, of about the last 60 frames; 0: unknown. `details`: the
// reader is an engineer, to whom missed deadlines are a problem.
HealthWords health_words(const HealthView& health, double recent_fps, bool details);
// Age of the sample, rate, round trip, stiffness limit and heat of a real device, or of one with a fault; else empty.
std::string device_line(const HealthView& health);

// Estimated height of draw_health.
float health_height(const HealthView& health, const ViewState& view);
void draw_health(const HealthView& health, ViewState& view, const UiStyle& style);

}  // namespace palpate
