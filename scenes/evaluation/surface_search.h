// Estimates the surface of a test recording for a given model: the shift of the positions, over all overlaps of
// recording and model, that minimises the error of the model's forces (profile_search.h). Errors are in JND with a
// Huber loss beyond 1; outside the surface the model's force is 0, as in the tick. A shift counts as 0 within two
// standard errors of 0, and is not identified if a force offset explains the data as well.
// Thread guarantee: slow side, pure.
#pragma once

#include <memory>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "models/samples/selection.h"
#include "models/samples/samples.h"

namespace palpate {

// `rows`: a whole recording in time order, thinned. The costs of several models are added. `at`: to be subtracted from
// position_m so that 0 is the models' surface, m. Without models or rows it is not identified.
OffsetEstimate locate_surface(const std::vector<Sample>& rows,
                              const std::vector<std::shared_ptr<const ForceModel>>& models, const JndLine& jnd);

}  // namespace palpate
