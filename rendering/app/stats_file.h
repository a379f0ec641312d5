// The JSON file of --stats: figures of the loop, the graphics and the models.
// Thread guarantee: the window's thread.
#pragma once

#include <string>

#include "rendering/panels/window_view.h"
#include "scenes/live/live_session.h"

namespace palpate {

// The keys are haptics, graphics, models, verdict, faults, scene, device and reference.
std::string stats_text(const LiveSession& session, const WindowView& shown, const FrameFigures& frames);

}  // namespace palpate
