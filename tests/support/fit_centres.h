// The function of a method that selects centres, in one call.
#pragma once

#include "models/correction/methods.h"
#include "models/model/correction.h"

namespace palpate::test {

// The parameters of MethodTask that a test sets.
struct CentreOptions {
  int centres = 100;
  int candidates = 100;
  std::uint64_t seed = 1;
};

inline Result<RbfFunction> fit_centres(const Method& method, const Sites& sites, const Eigen::VectorXd& jnd_N,
                                       const CentreOptions& options, const FitControl& control = {}) {
  MethodTask task{sites, jnd_N};
  task.centres = options.centres;
  task.candidates = options.candidates;
  task.seed = options.seed;
  const auto fitted = fit_correction(method, task, control);
  if (!fitted) return fitted.error();
  return *rbf_of(fitted->correction);
}

inline Result<RbfFunction> fit_random(const Sites& sites, const CentreOptions& options) {
  return fit_centres(kRandomMethod, sites, {}, options);
}
inline Result<RbfFunction> fit_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const CentreOptions& options) {
  return fit_centres(kKdTreeMethod, sites, jnd_N, options);
}
inline Result<RbfFunction> fit_greedy(const Sites& sites, const CentreOptions& options) {
  return fit_centres(kGreedyMethod, sites, {}, options);
}

}  // namespace palpate::test
