// What the person at the window has set, and what the window knows of itself.
// Thread guarantee: values of the window's thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/live/time_histogram.h"
#include "rendering/picture/camera.h"
#include "rendering/ui/colours.h"
#include "scenes/live/live_session.h"

namespace palpate {

inline constexpr double kShown_s = 10.0;       // of the curves at a time, as long as nobody zooms
inline constexpr double kLeastShown_s = 0.02;  // of the curves, zoomed in

inline constexpr float kSmallestText = 0.8F;  // times the usual size
inline constexpr float kLargestText = 1.6F;

// The part of the time that the curves show.
struct CurveTime {
  double zero_s = 0.0;  // loop time at which the axes' time begins
  double shown_s = kShown_s;
  // Curves stand still, and end so long before.
  bool paused = false;
  double paused_at_s = 0.0;  // loop time
  double scrolled_back_s = 0.0;
  // Loop time under the mouse, and where it began to drag; NaN: nothing of that.
  double hover_s = std::numeric_limits<double>::quiet_NaN();
  double drag_from_s = std::numeric_limits<double>::quiet_NaN();

  // The loop time at the right edge of the curves; `now_s` while they run.
  double end_s(double now_s) const noexcept { return paused ? paused_at_s - scrolled_back_s : now_s; }
  void pause(double at_s) noexcept;
  void run() noexcept {
    paused = false;
    scrolled_back_s = 0.0;
    shown_s = kShown_s;
  }
  // Stops and shows what lies between two times, in either order.
  void zoom(double one_s, double other_s) noexcept;
  // While paused; not beyond `oldest_s`, the first there is.
  void scroll_back(double by_s, double oldest_s) noexcept;
};

// The table of models: what it is sorted by, and the name that is being typed.
struct TableState {
  int column = -1;  // none: in the order in which they were asked for
  bool rising = false;
  std::array<char, 64> name{};
};

// A recording that somebody gave, and what it is to be.
struct OfferedRecording {
  enum class Role : std::uint8_t { train, test, none };
  std::string path;
  std::vector<std::string> words;  // how another program's table was understood
  Role role = Role::train;
};

// Recordings that wait for an answer: which to train on, which to test on.
struct Offer {
  std::vector<OfferedRecording> recordings;
  std::string problem;  // why a file is none
  bool any() const noexcept { return !recordings.empty() || !problem.empty(); }
  // Of several the last one is the test, until somebody says otherwise.
  void add(OfferedRecording recording);
  std::vector<std::string> training() const;
  std::string test() const;           // empty: none
  void make_test(std::size_t index);  // and no other
};

// The file that is looked for.
struct FilePicker {
  std::string folder;              // empty: not yet
  std::vector<std::string> files;  // in it
  std::array<char, 512> path{};    // that is typed
};

// What outlives a run: how things are shown, never what is shown.
struct Settings {
  Theme theme = Theme::light;
  std::size_t block_count = 4;      // 1, 2 or 4
  bool difference = true;           // below the force: of every tick, in the band; else its mean over 50 ms
  float text_size = 1.0F;           // times the usual
  std::string line_up;              // empty: the default
  std::vector<std::string> recent;  // files that were opened, the newest first
  CameraTurn camera;
};

// Windows over the picture, and what is in them.
struct Dialogs {
  bool help = false;
  bool file_list = false;   // files to open
  bool scene_list = false;  // scenes to choose from
  bool device_list = false;
  bool view_list = false;  // how things are shown
  Offer offer;
  FilePicker picker;
  std::vector<DeviceChoice> devices;  // empty: not looked for yet

  bool any() const noexcept { return help || file_list || scene_list || device_list || view_list || offer.any(); }
};

// What an exhibit asks of the picture.
struct ExhibitState {
  bool on = false;
  bool blind = false;         // which model is active is a secret
  bool tool_is_held = false;  // out of the block, whatever the mouse does
};

struct ViewState {
  Settings settings;
  Dialogs dialogs;
  ExhibitState exhibit;
  CurveTime time;
  TableState table;
  bool feel = false;                                   // the force in the hand is scaled
  bool exaggerated = false;                            // arrows show ten times the difference
  bool centres_together = true;                        // the slider moves all models that have centres
  int requested_centres = 0;                           // of the slider, as long as it is held
  bool details = false;                                // of the loop, faults
  bool has_pressed = false;                            // the person at the mouse knows how
  std::size_t pointed = static_cast<std::size_t>(-1);  // slot of the row under the mouse: its curves are named
  bool verdict = true;                                 // speed against error; else the error against the force
};

// How long frames take, and how many came in the last second.
struct FrameFigures {
  TimeHistogram times;  // from one frame's end to the next
  std::uint64_t frames = 0;
  double seconds = 0.0;
  double recent_fps = 0.0;
  float picture_scale = 1.0F;  // of the pixels a side of the 3-D view, see Resolution
};

struct Toast {
  std::string text;
  bool problem = false;
  double until_s = 0.0;  // window time
};

}  // namespace palpate
