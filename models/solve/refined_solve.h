// The system of projected_kernel.h behind a factor in single precision.
//
// It takes half of the time and memory of one in double precision. Conjugate gradients
// with it as preconditioner, and with products by the kernel in double precision, bring
// the residual down by two to four digits an iteration, to where the rounding of a double
// factor would leave it.
// Source: Golub & Van Loan (2013), 11.5; Higham (2002), 12 for what refinement can reach.
// Uses all cores. Off the tick.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "models/solve/projected_kernel.h"

namespace palpate {

struct RefinedSolution {
  Eigen::VectorXd u;
  double condition = 0.0;  // estimate, 1-norm
};

// (P K P + smoothing) u = P S f, to a residual of 1e-12 of P S f as the iteration has it;
// the true one is that of a double factor. None when it is too ill conditioned for single
// precision, or when `may_continue`, asked now and then with the share done, says no.
std::optional<RefinedSolution> solve_refined(const ProjectedKernel& kernel, double smoothing,
                                             const std::function<bool(double)>& may_continue);

}  // namespace palpate
