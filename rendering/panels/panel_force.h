// The panel's curves: live force against time with the JND band, and the error over
// the JND below.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/panel_views.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/curves.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

class ForceCurves {
 public:
  void draw(const ForceView& force, ViewState& view, const UiStyle& style, float force_height,
            float error_height);
  // The force plot alone, with the reference and the active model, which has no
  // colour of its own while it is a secret.
  void draw_for_visitors(const ForceView& force, ViewState& view, const UiStyle& style, float height);

 private:
  void gather(const ForceView& force, ViewState& view, double end_s);
  void draw_force(const ForceView& force, ViewState& view, const UiStyle& style, float height, double end_s);
  void draw_error(const ForceView& force, const ViewState& view, const UiStyle& style, float height,
                  double end_s);
  CurveColumns curves_;
};

}  // namespace palpate
