// What a scene asks of a fit, for the command line and the live session alike.
// Thread guarantee: pure function.
#pragma once

#include "models/fit/fit.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The scene's features and JND line; everything else as `palpate fit` has it by
// default.
TrainingRequest training_request(const Scene& scene);

// The same for a model that knows the depth alone.
TrainingRequest position_request(const Scene& scene);

}  // namespace palpate
