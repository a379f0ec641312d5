// The panel at the right: curves, models, errors, the loop's health. One file
// for each part; every one draws at the cursor of the current ImGui window.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <string>
#include <vector>

#include "rendering/ui/curves.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui_style.h"
#include "rendering/panels/view_state.h"
#include "scenes/live/live_session.h"

namespace palpate {

// Force against time with the JND band, and below it how far every model is from the
// reference: the difference in a band of constant height, or what a hand feels of it.
class ForceCurves {
 public:
  void draw(LiveSession& session, ViewState& view, const UiStyle& style, float force_height,
            float error_height);
  // The force plot alone, with the reference and the model in the hand, which has no
  // colour of its own while it is a secret.
  void draw_for_visitors(LiveSession& session, ViewState& view, const UiStyle& style, float height);
  const CurveColumns& columns() const noexcept { return curves_; }

 private:
  struct Scene;  // what all plots of a frame share
  Scene begin(const LiveSession& session, ViewState& view, const UiStyle& style);
  void draw_force(const Scene& scene, float height);
  void draw_difference(const Scene& scene, float height);
  void draw_felt(const Scene& scene, float height);
  void draw_titles_of_force(const Scene& scene) const;
  void draw_titles_of_error(const Scene& scene) const;
  void finish_plot(const Scene& scene, const Plot& plot, float (*value)(const CurveColumn&, std::size_t),
                   const char* unit);
  CurveColumns curves_;
  bool hovered_ = false;  // in this frame
};

// All of it.
class Panel {
 public:
  // Into a window at (x, y).
  void draw(LiveSession& session, ViewState& view, const UiStyle& style, const FrameFigures& frames,
            const ImVec2& at, const ImVec2& size);
  const CurveColumns& columns() const noexcept { return curves_.columns(); }

 private:
  ForceCurves curves_;
};

void draw_model_table(LiveSession& session, ViewState& view, const UiStyle& style, float height);
// The columns of that table that `room` holds, dropped in a fixed order: the error in
// millinewtons first, then centres, time, force, error over the JND. Name and share
// within the JND always stay.
std::vector<int> shown_columns(float room, float (*width)(int column));
void draw_error_bins(const LiveSession& session, const UiStyle& style, float height);
// Lines of text that draw_health takes, at most as a rule.
int health_lines(const LiveSession& session, const ViewState& view);
void draw_health(const LiveSession& session, ViewState& view, const UiStyle& style,
                 const FrameFigures& frames);

// What the panel's quiet line says; `problem` when it is not quiet.
struct HealthWords {
  std::string text;
  bool problem = false;
  bool past = false;  // over, said until the user has seen it (LiveSession::reset_figures)
};
HealthWords health_words(const LiveSession& session, const FrameFigures& frames);

// Whether the model in the hand is used where nothing was recorded.
bool away_from_data(const LiveSession& session);

// The colour of a model: of its method, another shade for each further one of it.
Rgb slot_colour(const LiveSession& session, std::size_t slot, Theme theme);

// Small parts that several use.
void section_title(const UiStyle& style, const char* title);
// A tooltip for the item before, below it or above it, never over it.
void tip(const char* text);

}  // namespace palpate
