// The onset of force in touches of a surface at rest; surface_estimate.h gives the equation.
// Thread guarantee: slow side, pure.
#pragma once

#include <cstddef>
#include <vector>

#include "models/samples/sample.h"

namespace palpate {

// One touch: the rows [begin, end) of its loading.
struct Touch {
  std::size_t begin = 0;
  std::size_t end = 0;
  double first_force_m = 0.0;  // position where the force leaves the noise: too deep if the onset is soft
};

struct Onset {
  double at_m = 0.0;
  double standard_error_m = 0.0;  // infinite if J has no minimum
  double misfit_m = 0.0;          // additional error if the force follows neither law
};

// The touches of a surface at rest that begin in free air. `zero_N`: force zero. `threshold_N`: force above the noise
// that counts as contact. `air_end_m`: free air is certain for positions below.
std::vector<Touch> touches_at_rest(const std::vector<Sample>& rows, double zero_N, double threshold_N,
                                   double air_end_m);

// The common onset of at least one touch; the coefficients a and b of each touch are its own.
Onset find_onset(const std::vector<Sample>& rows, const std::vector<Touch>& touches, double zero_N,
                 double force_noise_N);

}  // namespace palpate
