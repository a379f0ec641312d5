#include "models/correction/methods.h"

#include <algorithm>

#include "models/correction/algebra.h"

namespace palpate {

// The trend without a correction: the smallest model, and the baseline of every other method.
const Method kTrendMethod{
    .name = "trend",
    .label = "trend",
    .colour = 0xCC79A7,
    .expected_seconds = 0.01,
    .fit = [](const MethodTask&, const FitControl&) -> Result<FittedCorrection> { return FittedCorrection{}; },
};

const std::vector<const Method*>& methods() {
  static const std::vector<const Method*> table{&kTrendMethod,  &kDirectMethod, &kVoxelMethod,
                                                &kRandomMethod, &kKdTreeMethod, &kGreedyMethod};
  return table;
}

double expected_seconds(const Method& method) {
  return method.expected_seconds + (method.base == nullptr ? 0.0 : expected_seconds(*method.base));
}

Result<FittedCorrection> fit_correction(const Method& method, const MethodTask& task, const FitControl& control) {
  if (const Status status = validate_sites(task.sites); !status) return status.error();
  if (!control.may_continue(0.0)) return interrupted();
  if (method.base == nullptr || task.base != nullptr) return method.fit(task, control);
  const double share = expected_seconds(*method.base) / expected_seconds(method);
  const auto base = fit_correction(*method.base, task, control.part(0.0, share));
  if (!base) return base.error();
  MethodTask with_base = task;
  with_base.base = base->correction;
  return method.fit(with_base, control.part(share, 1.0));
}

Result<FittedCorrection> fit_centres(const MethodTask& task, const Eigen::MatrixXd& centres,
                                     const std::string& shortage) {
  FittedCorrection fitted = solve_weights(task.sites, centres);
  if (!fitted.function().weights.allFinite() || !fitted.function().tail.allFinite())
    return Error{"the weights of the centres could not be computed; check the recording for extreme values"};
  if (centres.cols() < task.centres)
    fitted.notes.push_back("only " + std::to_string(centres.cols()) + " centres: " + shortage);
  return fitted;
}

}  // namespace palpate
