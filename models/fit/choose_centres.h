// The methods that choose some centres, whose weights are then those of solve_weights.h.
// Centres, kernel, candidates and seed are those of the request. Fewer centres than asked,
// and why, where no further one is of use. The same request gives the same bits. Errors:
// those of validate_sites; interrupted. Off the tick.
#pragma once

#include "models/fit/methods.h"

namespace palpate {

// Distinct sites drawn without replacement, the first of one permutation: the fastest and
// the least accurate. Sites at the same point count once.
// Source: Hoever & Harders (2009), section 4.2.1.
Result<CentreSequence> choose_random(const Sites& sites, const MethodRequest& request);

// The sites are split into two leaves, whose barycentres are the centres; then, again and
// again, the function is fitted, the sample that exceeds the JND most is found, and its leaf
// is split at the median of its widest dimension, which replaces one centre by two.
//
// A refit costs one new pair of columns, not a new matrix: columns are kept with the
// polynomial tail projected out, their Gram matrix is updated and factorised (Cholesky, with
// a relative ridge of 1e-13). Sites at one point stay in one leaf; a leaf with a single point
// cannot be split, and the next worst sample is taken. O(N centres) a step.
// `jnd_N`: N thresholds > 0; a wrong one is an error.
// Source: Hoever & Harders (2009), section 4.2.2.
Result<CentreSequence> choose_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const MethodRequest& request,
                                     const FitControl& control = {});

// Starting from the polynomial tail, each step adds the site whose kernel column lowers the
// squared weighted error most, out of a random subset or out of all sites (orthogonal forward
// selection).
//
// Random subsets cost O(N candidates basis) a step. With all sites, squared lengths and
// correlations of all columns are updated by one product with the kernel matrix a step
// (|c'|^2 -= (q.c)^2, c.r -= (q.r)(q.c)); that product computes kernels as it goes, so memory
// stays O(N centres). Every chosen column is orthogonalised explicitly before it is accepted.
// Source: Hoever & Harders (2009), section 4.2.3; Chen, Cowan & Grant (1991) for the
// orthogonal form.
Result<CentreSequence> choose_greedy(const Sites& sites, const MethodRequest& request, const FitControl& control = {});

// The function of these centres; the report notes those that are missing. Slow side.
Result<FittedRbf> fit_centres(const Sites& sites, const MethodRequest& request, const Result<CentreSequence>& chosen,
                              const FitControl& control = {});
// Method::fit of every method that has a `choose`.
Result<FittedCorrection> fit_chosen(const MethodTask& task, const FitControl& control);

}  // namespace palpate
