// The onset of force of touches of a surface at rest; see surface_estimate.h
// for the equation.
// Thread guarantee: slow side, pure.
#pragma once

#include <cstddef>
#include <vector>

#include "models/surface/surface_rows.h"

namespace palpate {

// One touch: the rows [begin, end) on the way in.
struct Touch {
  std::size_t begin = 0;
  std::size_t end = 0;
  double first_force_m = 0.0;  // where force leaves its noise: late where the onset is soft
};

struct Onset {
  double at_m = 0.0;
  double standard_error_m = 0.0;  // infinite where there is no minimum
  double misfit_m = 0.0;          // a further error, where the force follows neither law
};

// `zero_N`: what the force sensor reads in air. `threshold_N`: beyond its noise. Of touches
// before which the tool was outside `air_end_m`.
std::vector<Touch> touches_at_rest(const std::vector<SurfaceRow>& rows, double zero_N, double threshold_N,
                                   double air_end_m);

// Of all `touches`, at least one, together; they share the onset and nothing else.
Onset find_onset(const std::vector<SurfaceRow>& rows, const std::vector<Touch>& touches, double zero_N,
                 double force_noise_N);

}  // namespace palpate
