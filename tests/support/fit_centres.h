// The function of a method that selects centres, in one call.
#pragma once

#include "models/correction/methods.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate::test {

inline Result<RbfFunction> fit_centres(const Method& method, const Sites& sites, const Eigen::VectorXd& jnd_N,
                                       MethodRequest request, const FitControl& control = {}) {
  request.method = &method;
  const auto fitted = fit_correction({sites, jnd_N, request}, control);
  if (!fitted) return fitted.error();
  return *rbf_of(fitted->correction);
}

inline Result<RbfFunction> fit_random(const Sites& sites, const MethodRequest& request) {
  return fit_centres(kRandomMethod, sites, {}, request);
}
inline Result<RbfFunction> fit_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const MethodRequest& request) {
  return fit_centres(kKdTreeMethod, sites, jnd_N, request);
}
inline Result<RbfFunction> fit_greedy(const Sites& sites, const MethodRequest& request) {
  return fit_centres(kGreedyMethod, sites, {}, request);
}

}  // namespace palpate::test
