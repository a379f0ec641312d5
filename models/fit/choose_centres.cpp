#include "models/fit/choose_centres.h"

#include <utility>

#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/solve_weights.h"

namespace palpate {

Result<FittedRbf> fit_centres(const Sites& sites, const MethodRequest& request, const Result<CentreSequence>& chosen,
                              const FitControl& control) {
  if (!chosen) return chosen.error();
  auto fitted = solve_weights(sites, request.kernel, chosen->centres_of(chosen->most));
  if (!control.may_continue(1.0)) return interrupted();
  if (!fitted) return fitted;
  if (!chosen->shortage.empty()) {
    fitted->report.notes.push_back("only " + std::to_string(chosen->most) + " centres: " + chosen->shortage);
  }
  return fitted;
}

Result<FittedCorrection> fit_chosen(const MethodTask& task, const FitControl& control) {
  const MethodRequest& request = task.request;
  auto fitted = fit_centres(task.sites, request, request.method->choose(task, control), control);
  if (!fitted) return fitted.error();
  return FittedCorrection{std::make_shared<const RbfCorrection>(std::move(fitted->function)), std::move(fitted->report),
                          std::to_string(request.centres)};
}

}  // namespace palpate
