// The methods that select centres; solve_weights.h then computes the weights. The number of centres, kernel, candidates
// and seed are those of the request. Fewer centres than requested are returned, with the reason, if no further one
// lowers the error. Deterministic. Errors: those of validate_sites; interrupted. Slow side.
#pragma once

#include "models/fit/methods.h"

namespace palpate {

// Distinct sites drawn without replacement, the first of one permutation: the fastest method and the least accurate.
// Source: Hoever & Harders (2009), section 4.2.1.
Result<CentreSequence> choose_random(const Sites& sites, const MethodRequest& request);

// The sites are split into two leaves, whose barycentres are the centres. Then, in each step, the function is fitted,
// the sample with the largest error over the JND is found, and its leaf is split at the median of its widest
// dimension, which replaces one centre by two.
//
// A refit costs one new pair of columns, not a new matrix: the polynomial tail is projected out of the columns, and
// their Gram matrix is updated and factorised (Cholesky, with a relative ridge of 1e-13). Duplicate sites stay in one
// leaf. A leaf with a single point cannot be split; the sample with the next largest error is taken. O(N centres) a
// step. `jnd_N`: the JND at each of the N sites, > 0, otherwise an error.
// Source: Hoever & Harders (2009), section 4.2.2.
Result<CentreSequence> choose_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const MethodRequest& request,
                                     const FitControl& control = {});

// Orthogonal forward selection, starting from the polynomial tail: each step adds the site whose kernel column lowers
// the weighted squared error most, from a random subset of the sites or from all.
//
// Random subsets cost O(N candidates basis) a step. With all sites, one product with the kernel matrix a step updates
// the squared norms and correlations of all columns (|c'|^2 -= (q.c)^2, c.r -= (q.r)(q.c)); it computes the kernels
// itself, so memory is O(N centres). Every selected column is orthogonalised explicitly before it is accepted.
// Source: Hoever & Harders (2009), section 4.2.3; Chen, Cowan & Grant (1991) for the orthogonal form.
Result<CentreSequence> choose_greedy(const Sites& sites, const MethodRequest& request, const FitControl& control = {});

// Fits the weights of the selected centres; the report notes a shortage of centres. Slow side.
Result<FittedRbf> fit_centres(const Sites& sites, const MethodRequest& request, const Result<CentreSequence>& chosen,
                              const FitControl& control = {});
// Implements Method::fit for every method with a `choose`.
Result<FittedCorrection> fit_chosen(const MethodTask& task, const FitControl& control);

}  // namespace palpate
