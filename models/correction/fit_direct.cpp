#include "models/correction/fit_direct.h"

#include <string>
#include <utility>

#include "engine/base/parallel.h"
#include "models/correction/projected_kernel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"

namespace palpate {

Result<SolvedWeights> fit_direct(const Sites& sites, const FitControl& control) {
  if (sites.count() > kMostDirectSites)
    return Error{"a direct fit of " + std::to_string(sites.count()) + " sites is too large, at most " +
                 std::to_string(kMostDirectSites) + "; thin the recording further or use greedy"};
  if (!control.may_continue(0.0)) return interrupted();
  const BlasThreads threads(thread_count());
  const ProjectedKernel kernel(sites.kernel, sites.points, sites.row_scale);
  if (!control.may_continue(0.1)) return interrupted();
  const auto factor = kernel.cholesky(sites.smoothing, control.part(0.1, 0.95));
  if (!factor && !control.may_continue(0.95)) return interrupted();
  if (!factor) return Error{"the kernel matrix could not be factorised; check the recording for extreme values"};
  if (!control.may_continue(0.95)) return interrupted();
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  Eigen::VectorXd u = kernel.project(data);
  cholesky_solve(factor->lower, u);
  u = kernel.project(u);
  // S G d = S f - K u - smoothing u, whose last term is orthogonal to the columns of S G.
  const Eigen::VectorXd tail = kernel.tail_of(data - kernel.multiply_kernel(u));
  return SolvedWeights{
      {sites.kernel, sites.points, definiteness_sign(sites.kernel) * u.cwiseProduct(sites.row_scale), tail},
      sites.count(),
      cholesky_condition(factor->lower, factor->norm)};
}

const Method kDirectMethod{
    .name = "direct",
    .label = "direct",
    .colour = kNeutralColour,
    .takes = kTakesKernel,
    .expected_seconds = 3.0,
    .fit = [](const MethodTask& task, const FitControl& control) -> Result<FittedCorrection> {
      auto solved = fit_direct(task.sites, control);
      if (!solved) return solved.error();
      return FittedCorrection{std::make_shared<const RbfCorrection>(std::move(solved->function)),
                              {},
                              solved->rank,
                              solved->condition_number};
    },
};

}  // namespace palpate
