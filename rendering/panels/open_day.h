// --kiosk: an exhibit in place of the panel. A question, a try, an answer, a reveal:
//
//   nobody    the hand presses by itself, one sentence invites
//   question  two models under two large buttons, which is which hidden; nothing on the
//             screen gives the answer away
//   reveal    the answer beside what was measured, in plain names, both curves in the band
//
// Buttons, touch and keys do the same: 1 and 2 choose a block, D and S answer, N goes on,
// L is the next language. 20 s without anybody: all of it is forgotten.
// Thread guarantee: the window's thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "rendering/panels/panel_force.h"
#include "rendering/panels/view_state.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/ab_trial.h"
#include "scenes/live/exhibit_words.h"
#include "scenes/live/live_session.h"

namespace palpate {

class OpenDay {
 public:
  explicit OpenDay(std::uint64_t seed) : trial_(seed) {}
  // `languages`: at least one. `tally_path`: empty: not kept.
  void set_up(std::vector<ExhibitWords> languages, const std::string& tally_path);

  // Once a frame: visitors come and go. Whether the last one has just left.
  bool update(LiveSession& session, ViewState& view);
  // A key of GLFW.
  void press_key(int key, LiveSession& session, ViewState& view);
  void draw(LiveSession& session, ViewState& view, const UiStyle& style, const ImVec2& at,
            const ImVec2& size);

  const AbTrial& trial() const noexcept { return trial_; }
  const ExhibitTally& tally() const noexcept { return tally_; }
  // Where the large buttons of the last frame are, by the key that does the same.
  const std::map<std::string, ImVec2>& buttons() const noexcept { return buttons_; }
  // The sentences of the reveal; empty before.
  std::vector<std::string> reveal() const;

 private:
  void begin(LiveSession& session, ViewState& view);
  void forget(LiveSession& session, ViewState& view);
  void try_model(int number, LiveSession& session, ViewState& view);
  void answer(bool different, ViewState& view);
  void update_ticks(const LiveSession& session);
  void draw_nobody(LiveSession& session, ViewState& view, const UiStyle& style, const ImVec2& size);
  void draw_question(LiveSession& session, ViewState& view, const UiStyle& style);
  void draw_reveal(LiveSession& session, ViewState& view, const UiStyle& style, float height);
  void draw_foot(const LiveSession& session, const UiStyle& style, const ImVec2& at, const ImVec2& size);
  bool large_button(const UiStyle& style, const std::string& text, const char* key, float width, bool down);
  std::string plain_name(const TrialModel& model) const;
  const ExhibitWords& words() const { return languages_[language_]; }

  AbTrial trial_;
  ForceCurves curves_;
  std::vector<ExhibitWords> languages_{1};
  std::size_t language_ = 0;
  std::string tally_path_;
  ExhibitTally tally_;
  std::map<std::string, ImVec2> buttons_;  // their middles
  bool visitor_ = false;
  double began_s_ = 0.0;       // of the trial, loop time
  double seen_s_ = 0.0;        // loop time of the last tick that the trial has
  double last_contact_s_ = 0.0;  // loop time at which somebody last did something
  std::size_t home_ = 0;  // the active slot when nobody is there
};

}  // namespace palpate
