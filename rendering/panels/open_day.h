// --kiosk: what a visitor of an open day sees in place of the panel. One sentence,
// the curve in its band, and "can you feel the difference?" between two models
// under the keys 1 and 2.
//
// Nobody there: the hand presses by itself and the words invite. Somebody moves the
// mouse: a new trial, clean. Idle for 20 s: all of it is forgotten.
// Thread guarantee: the window's thread.
#pragma once

#include <cstdint>

#include "rendering/panels/panel_force.h"
#include "rendering/ui/ui_style.h"
#include "rendering/panels/view_state.h"
#include "scenes/live/ab_trial.h"
#include "scenes/live/live_session.h"

namespace palpate {

class OpenDay {
 public:
  explicit OpenDay(std::uint64_t seed) : trial_(seed) {}

  // Once a frame: visitors come and go.
  void update(LiveSession& session, ViewState& view);
  // A key of GLFW: 1 and 2 try, D and S answer, N goes on.
  void press_key(int key, LiveSession& session, ViewState& view);
  void draw(LiveSession& session, ViewState& view, const UiStyle& style, const ImVec2& at,
            const ImVec2& size);

  const AbTrial& trial() const noexcept { return trial_; }

 private:
  void begin(LiveSession& session, ViewState& view);
  void forget(LiveSession& session, ViewState& view);
  void try_model(int number, LiveSession& session, ViewState& view);
  void draw_trial(const UiStyle& style, float width) const;
  void draw_keys(const UiStyle& style, float width) const;

  AbTrial trial_;
  ForceCurves curves_;
  bool visitor_ = false;
  std::size_t home_ = 0;  // the active slot when nobody is there
};

}  // namespace palpate
