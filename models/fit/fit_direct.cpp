#include "models/fit/fit_direct.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/solve/projected_kernel.h"
#include "models/solve/truncated_svd.h"

namespace palpate {
namespace {

// Fractions of the fit, for its progress.
constexpr double kFactorisingFrom = 0.25;
constexpr double kFactorised = 0.95;

Result<FittedRbf> solve(const Sites& sites, const ProjectedKernel& kernel, double smoothing,
                        const FitControl& control) {
  bool cancelled = false;
  const auto may_continue = [&](double share) {
    cancelled = !control.may_continue(kFactorisingFrom + (kFactorised - kFactorisingFrom) * share);
    return !cancelled;
  };
  // If rounding made the matrix indefinite, the smoothing is multiplied by ten.
  for (int attempt = 0; attempt < 8; ++attempt, smoothing *= 10.0) {
    Eigen::MatrixXd matrix = kernel.matrix(kernel.mean_eigenvalue(), smoothing);
    const BlasThreads threads(thread_count());
    const double norm = symmetric_norm(matrix);
    const bool factorised = cholesky_in_place(matrix, may_continue);
    if (cancelled) return interrupted();
    if (!factorised) continue;
    Eigen::VectorXd u = kernel.data();
    cholesky_solve(matrix, u);
    u = kernel.project(u);
    FittedRbf fitted;
    fitted.function = kernel.function(u);
    fitted.function.weights *= sites.strength;
    fitted.function.tail *= sites.strength;
    FitReport& report = fitted.report;
    report.centres_used = sites.count();
    report.condition = cholesky_condition(matrix, norm);
    report.residual_rms = smoothing * u.norm() / std::sqrt(static_cast<double>(sites.count()));  // of the scaled rows
    report.smoothing = smoothing;
    return fitted;
  }
  return Error{"the kernel matrix could not be factorised; check the recording for extreme values"};
}

}  // namespace

Result<FittedRbf> fit_direct(const Sites& sites, KernelKind kind, std::optional<double> smoothing,
                             const FitControl& control) {
  if (sites.count() > kMostDirectSites)
    return Error{"a direct fit of " + std::to_string(sites.count()) + " sites is too large, at most " +
                 std::to_string(kMostDirectSites) + "; reduce the recording further or use greedy"};
  if (sites.as_2009) return truncated_interpolant(sites, kind, control);
  if (!control.may_continue(0.0)) return interrupted();
  const ProjectedKernel kernel(sites, kind);
  if (!control.may_continue(0.1)) return interrupted();
  if (!smoothing) {
    const auto found = smoothing_of(sites, kind);
    if (!found) return found.error();
    smoothing = *found;
  }
  if (!control.may_continue(0.2)) return interrupted();
  auto fitted = solve(sites, kernel, std::max(*smoothing, kernel.smallest_smoothing()), control);
  if (!control.may_continue(kFactorised)) return interrupted();
  return fitted;
}

const Method kDirectMethod{
    .name = "direct",
    .label = "direct",
    .colour = kNeutralColour,
    .takes = kTakesKernel,
    .expected_seconds = [](const MethodRequest&) { return 3.0; },
    .fit = [](const MethodTask& task, const FitControl& control) -> Result<FittedCorrection> {
      auto fitted = fit_direct(task.sites, task.request.kernel, {}, control);
      if (!fitted) return fitted.error();
      return rbf_correction(std::move(*fitted), "");
    },
};

}  // namespace palpate
