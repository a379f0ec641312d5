// The centres of a method, and their function, in one call.
#pragma once

#include <utility>

#include "models/fit/methods.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate::test {

inline Result<CentreSequence> choose(const Method& method, const Sites& sites, const Eigen::VectorXd& jnd_N,
                                     const MethodRequest& request) {
  return method.choose({sites, jnd_N, request}, {});
}

inline Result<FittedRbf> fit_centres(const Method& method, const Sites& sites, const Eigen::VectorXd& jnd_N,
                                     MethodRequest request, const FitControl& control = {}) {
  request.method = &method;
  auto fitted = fit_correction({sites, jnd_N, request}, control);
  if (!fitted) return fitted.error();
  return FittedRbf{*rbf_of(fitted->correction), std::move(fitted->report)};
}

inline Result<FittedRbf> fit_random(const Sites& sites, const MethodRequest& request) {
  return fit_centres(kRandomMethod, sites, {}, request);
}
inline Result<FittedRbf> fit_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const MethodRequest& request) {
  return fit_centres(kKdTreeMethod, sites, jnd_N, request);
}
inline Result<FittedRbf> fit_greedy(const Sites& sites, const MethodRequest& request) {
  return fit_centres(kGreedyMethod, sites, {}, request);
}

}  // namespace palpate::test
