// The training request of a scene, for the command line and the live session.
// Thread guarantee: pure functions.
#pragma once

#include "models/fit/fit.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The scene's features and JND line; everything else is the default of `palpate fit`.
TrainingRequest training_request(const Scene& scene);

// The same for a model with the depth as its only feature.
TrainingRequest position_request(const Scene& scene);

}  // namespace palpate
