// Energy that a tool in the closed loop exchanges with the rendered force, in prescribed
// cycles and in strokes of a hand.
#pragma once

#include <string>

#include "tests/support/closed_loop_rest.h"

namespace palpate::test {

inline constexpr Press kFirm{3.0, 5e-3};
inline constexpr Press kLight{0.3, 0.6e-3};
inline constexpr Press kFirmOnStiff{3.0, 1e-3};

inline constexpr double kSoftSpring_N_per_m = 600.0;  // as silicone at 3 N
inline constexpr double kStiffSpring_N_per_m = 3000.0;

// The damping of a spring force that is held for a tick and one tick late; negative.
double held_and_late_Ns_per_m(double stiffness_N_per_m);

// One line of the log.
void say(const std::string& who, const char* format, double first, double second);

// A grip so stiff that the tool follows the prescribed path.
Grip lead();

// Closed cycles within the block along a sine of `amplitude_m` about `middle_m`.
// Returns the damping that absorbs the same energy per cycle,
//   b = (put in - got out) / (pi w A^2),
// the minimum over 2 to 40 Hz. At or above 0 no cycle generates energy.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, double encoder_m, double amplitude_m,
                              Ticking ticking, bool passivity);
// The minimum over both encoders, amplitudes of 0.1 and 0.5 mm, even and uneven ticks.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, bool passivity = true);

struct Strokes {
  double worst_return = 0.0;  // largest ratio of energy returned to energy put in, of one stroke
  double lowest_J = 0.0;      // minimum of the energy balance over time
  double largest_N = 0.0;
  double largest_cost_jnd = 0.0;  // of the force that the controller takes away, over the JND
  double mean_cost_jnd = 0.0;     // its mean in contact
};

// Four strokes from the air and back into it, in 0.1 to 0.8 s.
Strokes stroke(const ForcePtr& model, const LoopSettings& settings, const Press& press);

}  // namespace palpate::test
