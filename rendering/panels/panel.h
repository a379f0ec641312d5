// The panel at the right: curves, models, errors, the loop's health. One pair of
// files and one view (panel_views.h) for each part; every one draws at the cursor of
// the current ImGui window.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/panel_force.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

class SidePanel {
 public:
  // Into a window at (x, y).
  void draw(LiveSession& session, ViewState& view, const UiStyle& style, const FrameFigures& frames, const ImVec2& at,
            const ImVec2& size);
  const CurveColumns& columns() const noexcept { return curves_.columns(); }

 private:
  ForceCurves curves_;
};

}  // namespace palpate
