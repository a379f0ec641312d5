// Random centres: Nc distinct sites drawn without replacement, then least
// squares through a truncated SVD. The fastest of the methods and the least
// accurate.
// Source: Hoever & Harders (2009), section 4.2.1.
#pragma once

#include <cstdint>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/solve/centre_sequence.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

namespace palpate {

struct RandomOptions {
  KernelKind kernel = KernelKind::cubic;
  Eigen::Index centres = 100;
  std::uint64_t seed = 1;
};

// The first of one permutation. Sites at the same point count once; more centres than
// distinct sites are cut to their number. Errors: those of validate_sites. The same
// seed gives the same bits. Off the tick.
Result<CentreSequence> choose_random(const Sites& sites, const RandomOptions& options);
// The same with the weights of solve_weights; the report notes what is missing.
Result<FittedRbf> fit_random(const Sites& sites, const RandomOptions& options, const FitControl& control = {});

}  // namespace palpate
