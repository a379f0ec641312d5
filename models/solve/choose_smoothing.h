// The smoothing of the direct fit, from the data alone and without refitting.
//
// One eigendecomposition of P K P (projected_kernel.h) for a subset of the
// sites, taken at even steps, gives the residuals of every left-out stroke in
// closed form for every smoothing: with H the smoother, group g left out,
//   e_g = (I - H)_gg^-1 ((I - H) y)_g
// (errors of neighbouring samples of a stroke are correlated, so that leaving
// out single samples would choose too little). With fewer than four strokes,
// or where that is singular, generalised cross-validation:
//   N |(I - H) y|^2 / trace(I - H)^2.
// What was left out lies where other samples are; both criteria are blind to what
// happens between clusters of samples, and may by luck choose next to nothing.
// So the smoothing is never below the most likely one (noise and function normal):
//   N ln(sum_i z_i^2 / (e_i + smoothing)) + sum_i ln(e_i + smoothing) least,
// e the eigenvalues and z the data's shares. On recordings it is the smaller one.
// The smoothing is the variance of the noise over that of the prior, which
// does not depend on N: what is best for the subset serves for all the sites.
// Sources: Craven & Wahba (1979); the group form follows from the block inverse;
// Wahba (1985) for the likelihood.
#pragma once

#include "engine/base/result.h"
#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

namespace palpate {

struct SmoothingChoice {
  double smoothing = 0.0;
  double criterion = 0.0;  // mean squared scaled residual of what was left out
  bool by_group = false;
};

// The largest subset: its eigendecomposition takes a quarter of a second.
inline constexpr Eigen::Index kSmoothingSubset = 1000;

// Errors: the eigendecomposition did not converge. Deterministic. Off the tick.
Result<SmoothingChoice> choose_smoothing(const Sites& sites, KernelKind kernel);

}  // namespace palpate
