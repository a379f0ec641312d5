// Selects the smoothing of a fit by maximum likelihood, from the data alone and without refitting, where
// cross-validation (models/fit/correction_strength.h) has not selected it.
//
// One eigendecomposition of P K P (projected_kernel.h) for an evenly spaced subset of up to 500 sites gives the
// likelihood of every smoothing, for normal noise and a normal prior whose scale is profiled out,
//   minimise N ln(sum_i z_i^2 / (e_i + smoothing)) + sum_i ln(e_i + smoothing),
// with the eigenvalues e and the components z of the data. The largest smoothing within two units of the maximum log
// likelihood is taken. Cross-validation by samples does not see errors between clusters of samples and can select
// almost no smoothing; the likelihood does not have this fault. The smoothing is the ratio of noise variance to prior
// variance and does not depend on N, so that of the subset is valid for all sites.
// Source: Wahba (1985).
#pragma once

#include "engine/base/result.h"
#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

namespace palpate {

// Errors: the eigendecomposition did not converge. Deterministic. Slow side.
Result<double> choose_smoothing(const Sites& sites, KernelKind kernel);
// Whether cross-validation has selected the smoothing; its value is valid for the cubic kernel only.
inline bool is_smoothing_selected(const Sites& sites, KernelKind kernel) {
  return sites.smoothing && kernel == KernelKind::cubic;
}
// The smoothing selected by cross-validation, otherwise by maximum likelihood.
Result<double> smoothing_of(const Sites& sites, KernelKind kernel);

}  // namespace palpate
