// What the person at the window has set, and what the window knows of itself.
// Thread guarantee: values of the window's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "engine/live/time_histogram.h"
#include "rendering/ui/colours.h"

namespace palpate {

inline constexpr double kShown_s = 10.0;  // of the curves at a time

struct ViewState {
  Theme theme = Theme::light;
  bool kiosk = false;
  int hidden_choice = 0;        // above 0: which model is active is a secret, shown as this
  std::size_t block_count = 1;  // 1, 2 or 4
  bool help = false;
  bool details = false;    // of the loop, faults
  bool file_list = false;  // models to load
  // Curves stand still, and end so long before now.
  bool paused = false;
  double paused_at_s = 0.0;  // loop time
  double scrolled_back_s = 0.0;
  double force_scale_N = 1.0;  // of the force plot, eases
  double error_scale = 2.0;    // of the error plot
};

// How long frames take, and how many came in the last second.
struct FrameFigures {
  TimeHistogram times;  // from one frame's end to the next
  std::uint64_t frames = 0;
  double seconds = 0.0;
  double recent_fps = 0.0;
};

struct Toast {
  std::string text;
  bool problem = false;
  double until_s = 0.0;  // window time
};

}  // namespace palpate
