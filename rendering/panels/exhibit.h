// --kiosk: an exhibit in place of the panel; scenes/live/exhibit_game.h has its rules.
//
//   attract   the hand presses two blocks by itself, the difference is drawn; one
//             sentence invites
//   guess     what the computer of this round remembers; would a hand notice?
//   press     15 s: one stroke on both blocks, the difference is drawn as it grows
//   reveal    both forces in the band where they differed most, and one sentence
//   score     the visitor's own, and one sentence to take home
//
// Buttons, touch and keys do the same; each button shows its key. Nobody "feels" without
// a force device. The tool is out of the block whenever nothing is to be pressed. A
// minute without a movement, the last quarter of it counted down: all is forgotten. The
// day's tally and the loop's health are the host's, behind Ctrl+Shift+T.
// Thread guarantee: the window's thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rendering/panels/layout.h"
#include "rendering/panels/window_view.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/exhibit_game.h"
#include "scenes/live/exhibit_words.h"
#include "scenes/live/live_session.h"

namespace palpate {

struct ExhibitTimes {
  double press_s = ExhibitGame::kPress_s;
  double stay_s = 60.0;  // without a movement
  double warn_s = 15.0;  // of these, counted down
};

class Exhibit {
 public:
  explicit Exhibit(std::uint64_t seed) : game_(seed) {}
  // `languages`: at least one. `tally_folder`: a file for each day; empty: not kept.
  void set_up(std::vector<ExhibitWords> languages, const std::string& tally_folder, const ExhibitTimes& times);

  // Once a frame: visitors come and go. Whether the last one has just left.
  bool update(LiveSession& session, ViewState& view);
  // A key of GLFW.
  void press_key(int key, const LiveSession& session);
  void show_host(bool shown) noexcept { host_ = shown; }
  bool shows_host() const noexcept { return host_; }
  // The tool out of the block.
  static void let_go(LiveSession& session);
  // Beside the picture, and the names at its blocks.
  void draw(const LiveSession& session, const WindowView& shown, const BlockView& blocks, const UiStyle& style,
            const WindowLayout& layout);

  const ExhibitGame& game() const noexcept { return game_; }
  const ExhibitTrace& attract_trace() const noexcept { return trace_; }
  const ExhibitTally& tally() const noexcept { return tally_; }
  // Where the buttons of the last frame are, by the key that does the same.
  const std::map<std::string, ImVec2>& buttons() const noexcept { return buttons_; }
  // The sentences of the last frame, from the top.
  const std::vector<std::string>& said() const noexcept { return said_; }

 private:
  struct Canvas;  // what all screens of a frame share
  void forget(LiveSession& session, ViewState& view);
  void read_ticks(const LiveSession& session);
  void note_device(const LiveSession& session);
  void note_result();
  std::string tally_path() const;  // of today; empty: not kept
  void leave_reveal() { game_.go_on(); }
  void begin(const LiveSession& session);
  // The pair on the screen; null: nothing to compare yet.
  const ExhibitRound* pair() const noexcept;
  void draw_attract(const Canvas& canvas);
  void draw_guess(const Canvas& canvas);
  void draw_press(const Canvas& canvas);
  void draw_reveal(const Canvas& canvas);
  void draw_score(const Canvas& canvas);
  void draw_foot(const Canvas& canvas);
  void draw_host(const Canvas& canvas);
  void draw_names(const Canvas& canvas, const BlockView& blocks, const SceneArea& scene) const;
  void draw_difference(const Canvas& canvas, const ExhibitTrace& trace, double right_s);
  void draw_forces(const Canvas& canvas);
  float begin_plot(const Canvas& canvas, const std::string& title);
  bool button(const Canvas& canvas, const std::string& text, const std::string& key, float width, bool down = false);
  void say(const std::string& text);
  void say_quietly(const Canvas& canvas, const std::string& text);
  void draw_bar(const Canvas& canvas, const ExhibitRound& round);
  void draw_key(const Canvas& canvas, const ExhibitModel& model, const char* block);
  std::string verdict() const;
  std::string number(double value) const;
  std::string name_of(bool first, const LiveSession& session) const;
  const ExhibitWords& words() const { return languages_[language_]; }

  ExhibitGame game_;
  ExhibitTimes times_;
  std::optional<ExhibitRound> shown_;  // in attract mode
  ExhibitTrace trace_;                 // likewise
  std::vector<ExhibitWords> languages_{1};
  std::size_t language_ = 0;
  std::string tally_folder_;
  ExhibitTally tally_;
  std::map<std::string, ImVec2> buttons_;
  std::vector<std::string> said_;
  bool host_ = false;
  bool visitor_ = false;
  double moved_s_ = -1e9;     // loop time at which somebody last did something
  double seen_s_ = 0.0;       // loop time of the last tick that was taken in
  double device_at_m_ = 0.0;  // where a device's tool was when it last moved
  bool noted_ = false;        // the result of this round is in the tally
};

}  // namespace palpate
