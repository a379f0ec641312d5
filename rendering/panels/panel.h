// The panel beside the 3-D view: curves, models, errors, the loop's health. Each part reads a view of window_view.h
// and draws at the cursor of the current ImGui window: panel_force.cpp the curves, panel_models.cpp the table,
// panel_speed.cpp the plot of error against time. panel.cpp arranges them and has the others.
// Thread guarantee: the window's thread, inside a frame; functions without a window are pure.
#pragma once

#include <string>
#include <vector>

#include "rendering/panels/panel_parts.h"
#include "rendering/panels/time_plot.h"
#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

// The curves: force against time with the JND band, force against depth, and the difference of every model from the
// reference in JND, per tick or as its mean over 50 ms.
class ForceCurves {
 public:
  void draw(const WindowView& shown, ViewState& view, const UiStyle& style, float force_height, float error_height);

  const CurveColumns& columns() const noexcept { return columns_; }

 private:
  CurveColumns columns_;
  double force_scale_N_ = 1.0;  // upper end of the force axes; changes gradually
  double error_scale_ = 2.0;    // upper end of the error axis; changes gradually
};

// The table of models. A click on a row makes its model the active one. A right click opens a menu to rename it, to
// remove it, and to compare a model of another material.
void draw_model_table(LiveSession& session, const ModelsView& models, ViewState& view, const UiStyle& style,
                      float height);
// Which other models have the forces of this one, and why; empty: none. Begins with a line break.
std::string equal_words(const ModelInfo& info);
// The columns of that table that fit into `room`; `width` gives the width of a column. They are dropped in this order:
// error in mN, centres, force, share within the JND. Name, 99 % error and time always stay.
std::vector<int> shown_columns(float room, float (*width)(int column));

// The plot of error against time: one dot for each model, with the columns "99 % error / JND" and "ns" of the table.
void draw_speed(const ModelsView& models, const UiStyle& style, float height);
// Its axes: decimal logarithms of the time of a tick, ns, and of the error over the JND, with ranges that show all
// dots, their intervals and paths, and the JND. Without a model with errors the ranges are those of usual models.
PlotAxes speed_axes(const ModelsView& models);

// The status line of the loop.
struct HealthWords {
  std::string text;
  bool problem = false;
  bool past = false;  // a past alarm that is not acknowledged (LiveSession::reset_figures)
};
// `recent_fps`: frames per second, of about the last 60 frames; 0: unknown. `details`: the reader is an engineer, to
// whom missed deadlines are a problem.
HealthWords health_words(const HealthView& health, double recent_fps, bool details);
// Age of the sample, rate, round trip, stiffness limit and heat of a real device, or of one with a fault; else empty.
std::string device_line(const HealthView& health);

// Draws an ImGui window at `area`.
void draw_panel(ForceCurves& curves, LiveSession& session, const WindowView& shown, ViewState& view,
                const UiStyle& style, const SceneArea& area);

}  // namespace palpate
