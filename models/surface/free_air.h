// Evidence of free air in one recording; surface_estimate.h says what it is.
// Thread guarantee: slow side, pure.
#pragma once

#include <vector>

#include "models/surface/surface_rows.h"

namespace palpate {

struct FreeAir {
  bool found = false;
  double inner_end_m = 0.0;  // of the stretch
  double zero_N = 0.0;
  double zero_error_N = 0.0;  // standard error
  double drift_N = 0.0;       // of the zero, the last third minus the first
  double tool_mass_kg = 0.0;
};

// `force_noise_N`: its standard deviation.
FreeAir find_free_air(const std::vector<SurfaceRow>& rows, double force_noise_N);

// Takes the inertia of `mass_kg` off the forces.
void subtract_inertia(std::vector<SurfaceRow>& rows, double mass_kg);

}  // namespace palpate
