// The recipe of Hoever & Harders (2009), to compare with: 50 mN reduction, rows scaled by
// 1/f, depth, velocity and low-pass velocities with two relaxation times that are fitted to
// these recordings, as the paper fits its two to the transients of its own; the force itself as target; weights by
// truncated singular values (truncated_svd.h); positions as recorded, no trust, an even grid. Forces stay between 0
// (the least measured) and 1.2 times the largest measured, as those of every model.
// Thread guarantee: pure function.
#pragma once

#include "models/fit/fit.h"

namespace palpate {

// `request`: a scene's. Its features without a relaxation time stay as they are.
TrainingRequest recipe_2009_request(TrainingRequest request);

}  // namespace palpate
