// The smoothing of a fit where none was decided by strokes left out
// (models/fit/correction_strength.h), from the data alone and without refitting.
//
// One eigendecomposition of P K P (projected_kernel.h) for a subset of the sites, taken at
// even steps, gives the likelihood of every smoothing, with noise and function normal and the
// scale of the prior profiled out: e the eigenvalues and z the data's shares,
//   N ln(sum_i z_i^2 / (e_i + smoothing)) + sum_i ln(e_i + smoothing) least.
// What was left out of strokes lies where other samples are: such criteria are blind to what
// happens between clusters of samples, and may by luck choose next to nothing. This one is not.
// The smoothing is the variance of the noise over that of the prior, which
// does not depend on N: what is best for the subset serves for all the sites.
// Source: Wahba (1985).
#pragma once

#include "engine/base/result.h"
#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

namespace palpate {

// Errors: the eigendecomposition did not converge. Deterministic. Off the tick.
Result<double> choose_smoothing(const Sites& sites, KernelKind kernel);
// What was decided by leaving strokes out was so for the cubic kernel.
inline bool is_smoothing_decided(const Sites& sites, KernelKind kernel) {
  return sites.smoothing && kernel == KernelKind::cubic;
}
// That which was decided; otherwise the most likely.
Result<double> smoothing_of(const Sites& sites, KernelKind kernel);

}  // namespace palpate
