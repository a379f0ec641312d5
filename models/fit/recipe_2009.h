// The recipe of Hoever & Harders (2009), for comparison: 50 mN reduction; rows scaled by 1/f; depth, velocity and
// low-pass velocities as features, with two relaxation times identified from these recordings, as the paper identifies
// its two from the transients of its own; the force itself as target; weights by truncated singular values
// (truncated_svd.h); positions as recorded, no trust, an even grid. Forces are limited as in every model, to 1.2 times
// the largest measured one and to 0, or to the lowest one of a material that pulls.
// Thread guarantee: pure function.
#pragma once

#include "models/fit/fit.h"

namespace palpate {

// `request`: that of a scene. A scene without low-pass velocities gets no relaxation times.
TrainingRequest recipe_2009_request(TrainingRequest request);

}  // namespace palpate
