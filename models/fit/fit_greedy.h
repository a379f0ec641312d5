// Greedy centres: starting from the polynomial tail, each step adds the site
// whose kernel column lowers the squared weighted error most, out of a random
// subset or out of all sites (orthogonal forward selection).
//
// Random subsets cost O(N candidates basis) a step. With all sites, squared
// lengths and correlations of all columns are updated by one product with the
// kernel matrix a step (|c'|^2 -= (q.c)^2, c.r -= (q.r)(q.c)); that product
// computes kernels as it goes, so memory stays O(N centres). Every chosen
// column is orthogonalised explicitly before it is accepted.
// Source: Hoever & Harders (2009), section 4.2.3; Chen, Cowan & Grant (1991)
// for the orthogonal form.
#pragma once

#include <cstdint>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/solve/centre_sequence.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

namespace palpate {

struct GreedyOptions {
  KernelKind kernel = KernelKind::cubic;
  Eigen::Index centres = 100;
  Eigen::Index candidates = 100;  // sites tried a step; 0 or at least N: all
  std::uint64_t seed = 1;         // of the random subsets
};

// The centres, in the order chosen. Fewer than asked when there are no more distinct
// sites or no remaining site adds anything. Errors: those of validate_sites;
// interrupted. The same seed gives the same bits. Off the tick.
Result<CentreSequence> choose_greedy(const Sites& sites, const GreedyOptions& options, const FitControl& control = {});
// The same with the weights of solve_weights; the report notes what is missing.
Result<FittedRbf> fit_greedy(const Sites& sites, const GreedyOptions& options, const FitControl& control = {});

}  // namespace palpate
