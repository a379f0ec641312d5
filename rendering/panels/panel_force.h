// The panel's curves: force against time with the JND band, force against depth, and the difference of every model
// from the reference in JND, per tick or as its mean over 50 ms.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/curves.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

class ForceCurves {
 public:
  void draw(const WindowView& shown, ViewState& view, const UiStyle& style, float force_height, float error_height);

  const CurveColumns& columns() const noexcept { return curves_; }

 private:
  struct Drawing;  // common data of all plots of a frame
  Drawing begin(const WindowView& shown, ViewState& view, const UiStyle& style);
  void draw_force(const Drawing& drawing, const ImVec2& size);
  void draw_loops(const Drawing& drawing, const ImVec2& size);
  void draw_difference(const Drawing& drawing, float height);
  void draw_sustained(const Drawing& drawing, float height);
  void draw_titles_of_force(const Drawing& drawing, float width) const;
  void draw_titles_of_error(const Drawing& drawing) const;
  void finish_plot(const Drawing& drawing, const LivePlot& plot, float (*value)(const CurveColumn&, std::size_t),
                   const char* unit);
  CurveColumns curves_;
  double force_scale_N_ = 1.0;  // upper end of the force axes; changes gradually
  double error_scale_ = 2.0;    // upper end of the error axis; changes gradually
  bool hovered_ = false;        // the mouse is over a plot in this frame
};

}  // namespace palpate
