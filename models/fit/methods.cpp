#include "models/fit/methods.h"

#include <algorithm>
#include <optional>
#include <utility>

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

Result<FittedCorrection> fit_correction(const MethodTask& task, const FitControl& control) {
  const Method& method = *task.request.method;
  if (method.base == nullptr || task.base != nullptr) return method.fit(task, control);
  MethodRequest of_base = task.request;
  of_base.method = method.base;
  const auto base = fit_correction({task.sites, task.features, task.jnd_N, of_base, nullptr}, control);
  if (!base) return base.error();
  return method.fit({task.sites, task.features, task.jnd_N, task.request, &*base}, control);
}

double expected_seconds(const MethodRequest& request) {
  double seconds = 0.0;
  for (const Method* method = request.method; method != nullptr; method = method->base) {
    seconds += method->expected_seconds(request);
  }
  return seconds;
}

}  // namespace palpate
