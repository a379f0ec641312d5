// Where the surface of a tested recording is for a model that is there already: the shift
// that minimises the error of its forces, over all positions at which the recording
// overlaps the model's depths (profile_search.h). Errors count in units of the JND, in
// proportion beyond one, so that no bad stretch decides; before the surface the model's
// force is 0, as in the tick. Within two standard errors of where it was recorded nothing is moved.
// Thread guarantee: slow side, pure.
#pragma once

#include <memory>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "models/surface/profile_search.h"
#include "models/surface/surface_rows.h"

namespace palpate {

// `rows`: a whole recording in time order, thinned. `at`: to be subtracted from position_m
// so that 0 is where the models' surface is, m. Without models, or without rows, not told.
Located locate_surface(const std::vector<SurfaceRow>& rows,
                       const std::vector<std::shared_ptr<const ForceModel>>& models, const JndLine& jnd);

}  // namespace palpate
