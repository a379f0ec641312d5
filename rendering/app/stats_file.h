// What --stats writes: how the loop, the picture and the models did, as JSON.
// Thread guarantee: the window's thread.
#pragma once

#include <string>

#include "rendering/panels/window_view.h"
#include "scenes/live/live_session.h"

namespace palpate {

// The keys are those of the contract: haptics, graphics, models, faults.
std::string stats_text(const LiveSession& session, const WindowView& shown, const FrameFigures& frames);

}  // namespace palpate
