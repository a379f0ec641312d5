// One model of a session as a window shows it: plain data.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "scenes/evaluation/error_figures.h"
#include "scenes/live/error_quantile.h"

namespace palpate {

enum class SlotState : std::uint8_t {
  waiting,
  fitting,
  ready,
  failed,
  hidden,  // of a line-up that is not shown, or removed: not evaluated, not listed
};

struct SlotView {
  std::string name;    // distinct among the slots
  std::string method;  // a method's name; "position" for depth alone
  int centres = 0;     // nodes for a grid; 0 until ready
  SlotState state = SlotState::waiting;
  double progress = 0.0;  // of the fit, 0..1
  std::string problem;    // when failed
  // Of another material than the one that is pressed, as far as anybody knows: there is
  // nothing to compare it with.
  bool foreign = false;
  double force_N = 0.0;  // in the newest tick; 0 until ready
  bool out_of_domain = false;
  // Of the force, 95 % (models/model); NaN: unknown. All there is without a reference.
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();
  double tick_ns = 0.0;    // a whole tick of this model alone, measured when it became ready
  bool refitting = false;  // with another number of centres; the old one is there until then
  bool takes_centres = false;
  bool paper = false;  // by the recipe of 2009
  // Since the last reset, over samples in contact and inside the data of all models
  // that are compared: the same samples for each.
  ErrorFigures errors;
  ErrorQuantile quantile;                   // of the same samples
  std::uint64_t samples_out_of_domain = 0;  // left out for being outside the data of one
  // For drawing. Depth of the dent: the tool's while it presses, behind it the
  // surface's slow return, which follows the model's own relaxation times.
  double dent_m = 0.0;
  // Colours the dent: the largest recent error over the JND that a hand feels
  // (scenes/live/felt_error.h), fading within 0.3 s.
  double recent_peak_error_over_jnd = 0.0;
};

}  // namespace palpate
