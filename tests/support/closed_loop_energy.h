// What a tool in the closed loop exchanges with the rendered force: cycles that are led,
// strokes in a hand.
#pragma once

#include <string>

#include "tests/support/closed_loop_rest.h"

namespace palpate::test {

inline constexpr Press kFirm{3.0, 5e-3};
inline constexpr Press kLight{0.3, 0.6e-3};
inline constexpr Press kFirmOnStiff{3.0, 1e-3};

inline constexpr double kSoftSpring_N_per_m = 600.0;  // as silicone at 3 N
inline constexpr double kStiffSpring_N_per_m = 3000.0;

// Of a force that is held for a tick and comes late; negative damping.
double held_and_late_Ns_per_m(double stiffness_N_per_m);

// One line of the log.
void say(const std::string& who, const char* format, double first, double second);

// Not a hand: it leads the tool where it wants.
Grip lead();

// Closed cycles within the block, the tool led along a sine of `amplitude_m`
// about `middle_m`: the damping that takes the same energy per cycle,
//   b = (put in - got out) / (pi w A^2),
// the least of 2 to 40 Hz. At or above 0: no energy comes out of any cycle.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, double encoder_m, double amplitude_m,
                              Ticking ticking, bool passivity);
// The least of both encoders, of 0.1 and 0.5 mm, of even and uneven ticks.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, bool passivity = true);

struct Strokes {
  double worst_return = 0.0;  // got out over put in, of single strokes
  double lowest_J = 0.0;      // of the balance at any time
  double largest_N = 0.0;
  double largest_cost_jnd = 0.0;  // of what the controller takes, over the JND
  double mean_cost_jnd = 0.0;     // in contact
};

// Four strokes from the air and back into it, in 0.1 to 0.8 s.
Strokes stroke(const ForcePtr& model, const LoopSettings& settings, const Press& press);

}  // namespace palpate::test
