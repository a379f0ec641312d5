// Relaxation times identified from recordings.
//
// For given times the trend (models/model/trend.h) is linear in its coefficients, so
// the times are the only nonlinear unknowns (variable projection). The branch
// columns of a logarithmic ladder of times are filtered once; every choice of
// one to three of them is then a small non-negative least-squares problem on
// parts of one Gram matrix, so the search is exhaustive and cannot start badly. A
// finer ladder around the best choice of each number of times refines it.
//
// How many: cross-validation over strokes. The fewest times whose
// error, on the strokes left out, is within 5 % of the best. Uncertainty: delete-
// one-fold jackknife over the same folds.
// Source: generalised Maxwell model of Hoever & Harders (2009), section 2.1,
// who fitted their two times to recorded transients.
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "engine/tick/jnd.h"
#include "engine/base/result.h"
#include "engine/base/fit_control.h"
#include "models/training/motion_source.h"
#include "models/training/weighting.h"

namespace palpate {

struct IdentifiedTime {
  double time_s = 0.0;
  double standard_error_s = 0.0;
};

struct RelaxationIdentification {
  std::vector<IdentifiedTime> times;  // ascending, one to three
  // Cross-validated RMS of (f - T) / JND with one, two and three times.
  std::vector<double> error_over_jnd;
};

// `reference_depth_m`: greatest depth; `thinning_velocity_m_per_s`: as in TrendRows. Errors: those of the source; interrupted;
// fewer than 50 samples in contact.
Result<RelaxationIdentification> identify_relaxation(MotionSource& source, double reference_depth_m,
                                                     double thinning_velocity_m_per_s, Weighting weighting, const JndLine& jnd,
                                                     double force_noise_floor_N, const FitControl& control);

}  // namespace palpate
