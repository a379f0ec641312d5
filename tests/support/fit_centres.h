// Centres of a method and their function in one call.
#pragma once

#include "models/fit/choose_centres.h"

namespace palpate::test {

inline Result<FittedRbf> fit_random(const Sites& sites, const MethodRequest& request) {
  return fit_centres(sites, request, choose_random(sites, request));
}
inline Result<FittedRbf> fit_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const MethodRequest& request,
                                    const FitControl& control = {}) {
  return fit_centres(sites, request, choose_kdtree(sites, jnd_N, request, control), control);
}
inline Result<FittedRbf> fit_greedy(const Sites& sites, const MethodRequest& request, const FitControl& control = {}) {
  return fit_centres(sites, request, choose_greedy(sites, request, control), control);
}

}  // namespace palpate::test
