// The step of prepare_training that decides how far the trend is corrected and how
// wrong the models will be: from the samples kept for evaluation, their folds left out in
// turn (correction_strength.h, calibrate_bound.h).
// Thread guarantee: slow side.
#pragma once

#include <cstddef>

#include "engine/tick/jnd.h"
#include "models/fit/fit.h"

namespace palpate {

// Sets the strength, the sites' smoothing, the guard's radii and the error bounds.
// `strokes`: contacts in all recordings; few of them tell little of how much one
// differs from the next.
void decide_strength(PreparedTraining& prepared, const JndLine& jnd, int folds, std::size_t strokes);

}  // namespace palpate
