#include "models/fit/methods.h"

#include <algorithm>
#include <utility>

#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {
namespace {

template <typename Wanted>
std::string joined_names(Wanted wanted) {
  std::string names;
  for (const Method* method : methods()) {
    if (wanted(*method)) names += (names.empty() ? "" : ", ") + std::string(method->name);
  }
  return names;
}

// The correction of a method that selects centres.
Result<FittedCorrection> fit_chosen(const MethodTask& task, const FitControl& control) {
  const MethodRequest& request = task.request;
  const auto chosen = request.method->choose(task, control);
  if (!chosen) return chosen.error();
  auto fitted = solve_weights(task.sites, request.kernel, chosen->centres_of(chosen->most()));
  if (!control.may_continue(1.0)) return interrupted();
  if (!fitted) return fitted.error();
  if (!chosen->shortage.empty()) {
    fitted->report.notes.push_back("only " + std::to_string(chosen->most()) + " centres: " + chosen->shortage);
  }
  return rbf_correction(std::move(*fitted), std::to_string(request.centres));
}

}  // namespace

const std::vector<const Method*>& methods() {
#define PALPATE_LIST_METHOD(row) &row,
  static const std::vector<const Method*> table = {PALPATE_METHODS(PALPATE_LIST_METHOD)};
#undef PALPATE_LIST_METHOD
  return table;
}

const Method* find_method(std::string_view name) {
  const auto& all = methods();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Method* method) { return method->name == name; });
  return at == all.end() ? nullptr : *at;
}

std::string method_names() {
  return joined_names([](const Method&) { return true; });
}

std::string methods_that_take(MethodOption option) {
  return joined_names([option](const Method& method) { return method.can_take(option); });
}

FittedCorrection rbf_correction(FittedRbf fitted, std::string size) {
  return {std::make_shared<const RbfCorrection>(std::move(fitted.function)), std::move(fitted.report), std::move(size)};
}

Result<FittedCorrection> fit_correction(const MethodTask& task, const FitControl& control) {
  if (const Status status = validate_sites(task.sites); !status) return status.error();
  const Method& method = *task.request.method;
  if (method.choose != nullptr) return fit_chosen(task, control);
  if (method.base == nullptr || task.base != nullptr) return method.fit(task, control);
  MethodRequest of_base = task.request;
  of_base.method = method.base;
  const auto base = fit_correction({task.sites, task.jnd_N, of_base}, control);
  if (!base) return base.error();
  return method.fit({task.sites, task.jnd_N, task.request, &*base}, control);
}

double expected_seconds(const MethodRequest& request) {
  double seconds = 0.0;
  for (const Method* method = request.method; method != nullptr; method = method->base) {
    seconds += method->expected_seconds(request);
  }
  return seconds;
}

}  // namespace palpate
