// The trend method: the viscoelastic trend of prepare_training without a correction. It is the smallest model and the
// baseline of every other method.
#include <cmath>

#include "models/fit/methods.h"

namespace palpate {
namespace {

Result<FittedCorrection> fit_nothing(const MethodTask& task, const FitControl& control) {
  if (!control.may_continue(0.0)) return interrupted();
  FitReport report;
  const double squares = task.sites.row_scale.cwiseProduct(task.sites.target_N).squaredNorm();
  report.residual_rms = std::sqrt(squares / static_cast<double>(task.sites.count()));
  return FittedCorrection{std::make_shared<const NoCorrection>(), report, ""};
}

}  // namespace

const Method kTrendMethod{
    .name = "trend",
    .label = "trend",
    .colour = 0xCC79A7,
    .expected_seconds = [](const MethodRequest&) { return 0.01; },
    .fit = fit_nothing,
};

}  // namespace palpate
