// The panel's lowest part: how the loop and the device are.
// Thread guarantee: the window's thread, inside a frame; the words need no window.
#pragma once

#include <string>

#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// What the quiet line says; `problem` when it is not quiet.
struct HealthWords {
  std::string text;
  bool problem = false;
  bool past = false;  // over, shown until the user has seen it (LiveSession::reset_figures)
};
// `recent_fps`: frames in the last second; 0: not known.
HealthWords health_words(const HealthView& health, double recent_fps);
// Age of the sample, round trip and heat, of a device that has them; else empty.
std::string device_line(const HealthView& health);

// What draw_health takes of the panel's height, at most as a rule.
float health_height(const HealthView& health, const ViewState& view);
void draw_health(const HealthView& health, ViewState& view, const UiStyle& style, const FrameFigures& frames);

}  // namespace palpate
