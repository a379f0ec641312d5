// The panel's curves: force against time with the JND band, force against depth, and the difference of every model
// from the reference in JND, per tick or as its mean over 50 ms.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/curves.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

class ForceCurves {
 public:
  void draw(const WindowView& shown, ViewState& view, const UiStyle& style, float force_height, float error_height);

  const CurveColumns& columns() const noexcept { return columns_; }

 private:
  CurveColumns columns_;
  double force_scale_N_ = 1.0;  // upper end of the force axes; changes gradually
  double error_scale_ = 2.0;    // upper end of the error axis; changes gradually
};

}  // namespace palpate
