// Fits with every number of centres up to a maximum, for a slider. Methods with nested selections (Method::choose)
// select centres once; a fit of k centres then only solves for weights.
//
// The rows of all sites are factorised once, with the tail before the kernel columns in the order of selection:
//   row_scale * (G Phi f) = Q T,  T upper triangular.
// The columns of k centres are non-zero only in the rows of T up to the last of these columns, which leaves a system
// of that size. The weights equal those of a separate fit to rounding, with the same ridge or penalty. Smoothing and
// strength do not depend on the number of centres (model_validation.h). Every number has its own error bound: the
// rows without each fold are factorised, too.
// Thread guarantee: immutable; `fit` is slow side and may be called by several threads.
// Source: Golub & Van Loan, Matrix Computations, section 6.5 (QR of fewer columns).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/fit/fit.h"

namespace palpate {

class NestedWeights {
 public:
  // Factorises the rows. Errors: those of solve_weights. Takes about as long as solve_weights for all centres.
  static Result<NestedWeights> factorise(const Sites& sites, KernelKind kernel, CentreSequence sequence);

  Eigen::Index most() const { return sequence_.most(); }
  // The result of solve_weights for `count` centres, clamped to 0 to most().
  FittedRbf solve(Eigen::Index count) const;

 private:
  NestedWeights(KernelKind kernel, CentreSequence sequence, FactorisedRows factorised)
      : kernel_(kernel), sequence_(std::move(sequence)), factorised_(std::move(factorised)) {}
  FactorisedRows factorised_for(const std::vector<Eigen::Index>& columns) const;

  KernelKind kernel_;
  CentreSequence sequence_;
  FactorisedRows factorised_;
};

// The same for whole models.
class NestedFit {
 public:
  // Selects request.centres centres. `prepared` must outlive the fit, and must correct the trend
  // (PreparedTraining::corrects). Errors: the method has no `choose`; those of fit_method.
  static Result<NestedFit> make(const PreparedTraining& prepared, const MethodRequest& request,
                                const FitControl& control = {});

  Eigen::Index most() const { return weights_.most(); }
  // The result of fit_method for `count` centres, except that provenance.training_within_jnd is 0, because its
  // computation takes longer than the weights.
  Result<MethodFit> fit(Eigen::Index count) const;

 private:
  NestedFit(const PreparedTraining& prepared, const MethodRequest& request, NestedWeights weights)
      : prepared_(&prepared), request_(request), weights_(std::move(weights)) {}

  const PreparedTraining* prepared_;
  MethodRequest request_;
  NestedWeights weights_;
  std::vector<std::optional<NestedWeights>> without_fold_;  // none if no other fold has rows
};

}  // namespace palpate
