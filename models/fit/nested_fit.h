// Every number of centres of one fit, for a slider: methods whose choice of k centres
// goes on to k + 1 (Method::choose) choose once, and a fit of k is a matter of weights.
//
// The rows of all sites are folded once, with the tail before the kernel columns in the
// order in which they come in:
//   row_scale * (G Phi f) = Q T,  T upper triangular,
// and the columns of k centres have only as many rows of T as there are columns up to
// the last of them. What is left for k is a system of that size; the numbers are those
// of the direct fit to rounding, the ridge or the penalty included. Smoothing and strength
// do not depend on the number of centres (correction_strength.h); the error bound is that of all of them.
//
// Thread guarantee: immutable once made; `fit` is slow side and may be called by
// several threads.
// Source: Golub & Van Loan, Matrix Computations, section 6.5 (QR of fewer columns).
#pragma once

#include <Eigen/Core>
#include <utility>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/fit/fit.h"
#include "models/solve/centre_sequence.h"
#include "models/solve/solve_weights.h"

namespace palpate {

class NestedWeights {
 public:
  // Errors: those of solve_weights. Takes about as long as solve_weights for the pool.
  static Result<NestedWeights> fold(const Sites& sites, KernelKind kernel, CentreSequence sequence,
                                    const FitControl& control = {});

  Eigen::Index most() const { return sequence_.most; }
  // solve_weights for `count` centres, clamped to 0 to most().
  FittedRbf solve(Eigen::Index count) const;

 private:
  NestedWeights(KernelKind kernel, CentreSequence sequence, FoldedRows folded);
  FoldedRows folded_for(const std::vector<Eigen::Index>& columns) const;

  KernelKind kernel_;
  CentreSequence sequence_;
  FoldedRows folded_;  // its triangle in the order G, Phi, f
};

// The same for models.
class NestedFit {
 public:
  // Chooses request.centres centres. Errors: the method has no `choose`; those of
  // fit_method.
  static Result<NestedFit> make(const PreparedTraining& prepared, const MethodRequest& request,
                                const FitControl& control = {});

  Eigen::Index most() const { return weights_.most(); }
  // What fit_method gives for so many centres, but for provenance.training_within_jnd,
  // which is 0: judging takes longer than the weights.
  Result<MethodFit> fit(Eigen::Index count) const;

 private:
  NestedFit(ModelData common, NestedWeights weights) : common_(std::move(common)), weights_(std::move(weights)) {}

  ModelData common_;
  NestedWeights weights_;
};

}  // namespace palpate
