// Selects what Hoever & Harders (2009) leave open for a fit to the measured force, by cross-validation: the order of
// the polyharmonic kernel, the normalisation of the features, and the regularisation.
//
// Normalisation divides feature k by range_k^a (4 sigma_k)^(1 - a), with a = 1/2 or 1. Methods that select centres are
// regularised by the truncation of their pseudo-inverse (eq. 8), and the direct interpolation by the smoothing of its
// Cholesky factor, which takes the place of the truncated pseudo-inverse of eq. 4: the first is a step and the second
// lambda / (lambda + smoothing) over the eigenvalues lambda (Hansen 1998, section 4.2).
//
// Each candidate is fitted on random centres to the sites outside of a fold and predicts the samples in contact of that
// fold (models/samples/cross_validation.h). The lowest score wins.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/correction/sites.h"
#include "models/model/fitted_model.h"

namespace palpate {

struct OpenChoices {
  KernelKind kernel = KernelKind::cubic;
  double range_exponent = 0.5;  // a
  double truncation = 0.0;      // of methods that select centres
  double smoothing = 0.0;       // of the direct interpolation
  double error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score)
};

// "cubic kernel, normalised by ...": what was selected, for the user.
std::string choices_text(const OpenChoices& choices, bool has_kernel = true);

// `features`: at the samples in contact, SI. `sites`: of the same samples, with targets. `common`: with the limits of
// the force. `centres`: of the method, 0: the direct interpolation. `kernel`: that of the plan, none: selected. Errors:
// interrupted.
Result<OpenChoices> select_open_choices(const Samples& samples, const Eigen::MatrixXd& features,
                                        const Normalisation& normalisation, const Sites& sites, const ModelData& common,
                                        int centres, std::optional<KernelKind> kernel, const FitControl& control);

}  // namespace palpate
