// The panel at the right: curves, models, errors, the loop's health. One pair of
// files and one view (window_view.h) for each part; every one draws at the cursor of
// the current ImGui window.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/layout.h"
#include "rendering/panels/panel_force.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

class SidePanel {
 public:
  // Into a window at `area`.
  void draw(LiveSession& session, const WindowView& shown, ViewState& view, const UiStyle& style,
            const FrameFigures& frames, const SceneArea& area);
  const CurveColumns& columns() const noexcept { return curves_.columns(); }

 private:
  ForceCurves curves_;
};

}  // namespace palpate
