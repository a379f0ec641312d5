// The panel's curves: force against time with the JND band, and below it how far every
// model is from the reference: the difference in a band of constant height, or what a
// hand feels of it.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <array>

#include "rendering/panels/panel_views.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/curves.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

class ForceCurves {
 public:
  void draw(const ForceView& force, ViewState& view, const UiStyle& style, float force_height, float error_height);

  const CurveColumns& columns() const noexcept { return curves_; }

 private:
  struct Scene;  // what all plots of a frame share
  Scene begin(const ForceView& force, ViewState& view, const UiStyle& style);
  void draw_force(const Scene& scene, float height);
  void draw_difference(const Scene& scene, float height);
  void draw_felt(const Scene& scene, float height);
  void draw_titles_of_force(const Scene& scene) const;
  void draw_titles_of_error(const Scene& scene) const;
  void finish_plot(const Scene& scene, const LivePlot& plot, float (*value)(const CurveColumn&, std::size_t),
                   const char* unit);
  CurveColumns curves_;
  std::array<std::array<float, kMaxModels>, 2> label_px_{};  // of both plots; 0: not yet
  bool hovered_ = false;                                     // in this frame
};

}  // namespace palpate
