// kD-tree centres: the sites are split into two leaves, whose barycentres are
// the centres; then, again and again, the function is fitted, the sample that
// exceeds the JND most is found, and its leaf is split at the median of its
// widest dimension, which replaces one centre by two.
//
// A refit costs one new pair of columns, not a new matrix: columns are kept
// with the polynomial tail projected out, their Gram matrix is updated and
// factorised (Cholesky, with a relative ridge of 1e-13). The final weights are
// those of solve_weights. Sites at one point stay in one leaf; a leaf with a
// single point cannot be split, and the next worst sample is taken.
// Source: Hoever & Harders (2009), section 4.2.2.
#pragma once

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/solve/centre_sequence.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

namespace palpate {

struct KdTreeOptions {
  KernelKind kernel = KernelKind::cubic;
  Eigen::Index centres = 100;
};

// `jnd_N`: N thresholds > 0; errors are compared with. Fewer centres than asked
// when no leaf can be split. Errors: those of validate_sites; a wrong jnd_N;
// interrupted. Deterministic. Off the tick; O(N centres) a step, memory N x centres.
Result<CentreSequence> choose_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const KdTreeOptions& options,
                                     const FitControl& control = {});
// The same with the weights of solve_weights; the report notes what is missing.
Result<FittedRbf> fit_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const KdTreeOptions& options,
                             const FitControl& control = {});

}  // namespace palpate
