// Detects free air in one recording; surface_estimate.h defines it.
// Thread guarantee: slow side, pure.
#pragma once

#include <vector>

#include "models/samples/profile_search.h"
#include "models/samples/sample.h"

namespace palpate {

struct FreeAir {
  bool found = false;
  double inner_end_m = 0.0;  // free air is certain for positions below
  double zero_N = 0.0;
  double zero_error_N = kUnknownError;  // standard error
  double drift_N = 0.0;       // of the zero: median of the last third of the rows in air minus that of the first
  double tool_mass_kg = 0.0;  // mass carried by the force sensor; 0 if not identified
};

// `rows`: in time order. `force_noise_N`: standard deviation.
FreeAir find_free_air(const std::vector<Sample>& rows, double force_noise_N);

// Subtracts the inertial force of `mass_kg` from the forces.
void subtract_inertia(std::vector<Sample>& rows, double mass_kg);

}  // namespace palpate
