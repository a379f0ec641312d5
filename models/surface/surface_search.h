// Where the surface of a tested recording is for models that are there already:
// the shift that minimises the error of their forces.
//
//   J(d0) = sum_models sum_i rho((F(p_i - d0) - f_i) / JND(f_i))
// over all rows; where p_i <= d0 the force F is 0, as in the tick. rho is
// Huber's: quadratic up to one JND, linear beyond, so that neither one model nor
// one bad stretch decides. A coarse scan, a golden section, then the parabola
// around the minimum, whose delete-one-block jackknife gives the error. An
// offset that cannot be told from 0 (two standard errors, 0.02 mm) is 0.
// Thread guarantee: slow side, pure.
#pragma once

#include <memory>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "models/surface/surface_rows.h"

namespace palpate {

struct SurfaceLocation {
  // To be subtracted from position_m so that 0 is where the models' surface is.
  double offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite where there is no minimum
};

// Rows that a search works on at most; thin longer recordings to these.
inline constexpr std::size_t kSearchRows = 4000;

// `rows`: a whole recording in time order, thinned. Without models, or without
// rows, 0 and infinite.
SurfaceLocation locate_surface(const std::vector<SurfaceRow>& rows,
                               const std::vector<std::shared_ptr<const ForceModel>>& models, const JndLine& jnd);

}  // namespace palpate
