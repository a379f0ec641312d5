// --kiosk: an exhibit instead of the panel; scenes/live/exhibit_game.h has its rules.
//
//   attract   the simulated hand presses the block and the best model with one stroke; then the same stroke is shown
//             again with the worst model, and so on; a sentence invites to play
//   press     two blocks without names, and a live plot of their difference; which one is the computer's?
//   reveal    the press with the largest difference in slow motion (ExhibitReveal), then names and result
//   score     all models judged by the visitor's own presses; then one sentence to take home, and the score of the day
//
// A key presses the button that shows it; the 1 and 2 of the keypad count as 1 and 2, its Enter and Space as Enter. If
// there is no button 2, 1 and Enter both press the only button. L changes the language. The tool can touch the block
// only in the screens attract and press. After `stay_s` without a movement the exhibit starts again; a countdown shows
// the last `warn_s`. Ctrl+Shift+T shows the health of the loop to the host.
//
// Thread guarantee: the window's thread.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/tick/jnd.h"
#include "rendering/panels/panel.h"
#include "scenes/live/exhibit_game.h"

namespace palpate {

// The reveal of a round: the visitor's press with the largest difference, in slow motion. The blocks show its motion
// and dents. Two arrows beside each other show the forces, in front of a band of one JND about the true one. Then the
// motion goes back to the moment of the largest difference and stands still there.
class ExhibitReveal {
 public:
  using Moment = ExhibitTrace::Column;

  // `slowness`: duration of the reveal / duration of the press. `now_s`, here and below: time of one steady clock, s.
  void start(const ExhibitTrace& trace, const JndLine& jnd, double slowness, double now_s);
  bool done(double now_s) const noexcept { return columns_since_start(now_s) >= end() + kBack; }
  Moment at(double now_s) const noexcept;
  // The force of the model, N: that of the mean over 50 ms of the difference.
  double model_N(const Moment& moment) const noexcept { return moment.true_N + moment.over_jnd * jnd_N(moment); }

  // Draws both arrows and the band into `area`. All moments of the press have the same scale. On the way back to the
  // largest difference, the arrows grow until they fill the area. `newtons`: the words of a force.
  void draw_arrows(const UiStyle& style, const SceneArea& area, double now_s, const Rgb& truth, const Rgb& computer,
                   bool computer_is_left, const std::function<std::string(double)>& newtons) const;

 private:
  static constexpr double kBack = 0.25 / ExhibitTrace::kColumn_s;  // duration of the way back, in columns

  double end() const noexcept { return static_cast<double>(moments_.size() - 1); }  // the last index into moments_
  double columns_since_start(double now_s) const noexcept {
    return (now_s - began_s_) / slowness_ / ExhibitTrace::kColumn_s;
  }
  // Share of the way back from the end of the press to the largest difference, 0 to 1, with a smooth start and end.
  double way_back(double now_s) const noexcept;
  double playhead(double now_s) const noexcept;  // index into moments_, with a fraction
  double jnd_N(const Moment& moment) const noexcept { return jnd_.at(moment.true_N); }

  std::vector<Moment> moments_{1};  // one for each column of the trace
  std::size_t largest_at_ = 0;
  JndLine jnd_;
  double slowness_ = 1.0, began_s_ = 0.0;
};

struct ExhibitTimes {
  double press_s = 15.0;  // the longest stroke of the invitation
  double stay_s = 60.0;   // time without a movement until the exhibit starts again
  double warn_s = 15.0;   // countdown at the end of it
  double slowness = 4.0;  // of the reveal
};

class Exhibit {
 public:
  // `languages`: at least one. `tally_folder`: folder of the files of the days' scores; empty: none is stored.
  void set_up(std::vector<ExhibitWords> languages, const std::string& tally_folder, const ExhibitTimes& times);

  // Call it once a frame. Returns whether the visitor has just left, so that the exhibit started again.
  bool update(const WindowView& shown, ViewState& view, const WindowActions& actions);
  void press_key(int key, const WindowView& shown);
  void toggle_host() noexcept { host_ = !host_; }
  void draw(const WindowView& shown, const BlockView& blocks, const UiStyle& style, const WindowLayout& layout);
  // The two blocks, the left one first; empty: too few models are ready.
  std::vector<BlockPose> shown_poses(const WindowView& shown, Theme theme) const;

  const ExhibitGame& game() const noexcept { return game_; }
  const ExhibitTrace& attract_trace() const noexcept { return shows_worst() ? worst_ : best_; }
  // Whether the last stroke is shown again with the worst model.
  bool shows_worst() const noexcept { return game_.state() == ExhibitGame::State::attract && repeats_; }
  // Hides which block is the computer's.
  bool is_blind() const noexcept { return game_.state() == ExhibitGame::State::press; }
  const ExhibitTally& tally() const noexcept { return tally_; }
  // The middles of the buttons of the last frame, by their keys.
  const std::map<std::string, ImVec2>& buttons() const noexcept { return buttons_; }
  // Whether all of the last screen is above its foot.
  bool fits() const noexcept { return fits_; }
  // The sentences of the last frame, from the top.
  const std::vector<std::string>& said() const noexcept { return said_; }

 private:
  struct Screens;
  void forget(const WindowView& shown, ViewState& view, const WindowActions& actions);
  void read_ticks(const WindowView& shown);
  void choose_attraction(const WindowView& shown);
  void note_device(const WindowView& shown);
  void begin_reveal(const WindowView& shown);
  bool reveal_is_done(const WindowView& shown) const;
  std::string tally_path() const;  // today's file; empty: none is stored
  void begin(const WindowView& shown);
  bool knows_pair() const noexcept { return game_.state() != ExhibitGame::State::attract || ready_; }
  const ExhibitLineUp& line_up() const noexcept {
    return game_.state() == ExhibitGame::State::attract ? attraction_ : game_.line_up();
  }
  std::size_t level() const noexcept;  // of the model on the screen
  bool computer_is_left() const noexcept;
  const ExhibitModel& computer() const { return line_up().levels[level()]; }
  Rgb colour_of_truth(const WindowView& shown, Theme theme) const;
  const ExhibitWords& words() const { return languages_[language_]; }

  ExhibitGame game_{1};  // seed
  ExhibitTimes times_;
  ExhibitLineUp attraction_;   // of the state attract
  ExhibitTrace best_, worst_;  // of one stroke
  bool ready_ = false;         // `attraction_` is known
  bool repeats_ = false;       // the stroke is shown again with the worst
  ExhibitReveal reveal_;
  std::vector<ExhibitWords> languages_{1};
  std::size_t language_ = 0;
  std::string tally_folder_;
  ExhibitTally tally_;
  std::map<std::string, ImVec2> buttons_;
  std::string pressed_;  // key of the button that the next frame takes as pressed; empty: none
  std::vector<std::string> said_;
  bool host_ = false, visitor_ = false;
  double moved_s_ = -1e9;     // loop time of the visitor's last action
  double seen_s_ = 0.0;       // loop time of the last processed tick
  double device_at_m_ = 0.0;  // position of the device's tool at its last movement
  bool farewell_ = false;     // the second screen of the score
  bool fits_ = true;
  bool revealed_ = false;  // the reveal of this round has begun, and its result is in the tally
};

}  // namespace palpate
