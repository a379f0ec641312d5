// Laws of memory in which the trend is not linear: whether the material's times grow with
// depth (`slowing` of the branches) and whether its surface stays behind a tool that
// retreats fast (`surface_lag`; engine/tick/features.h). Each is tried in turn and stays
// where the folds left out reward it (acceptance.h).
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/training/fold_dealer.h"
#include "models/training/motion_source.h"
#include "models/training/trend_dictionary.h"

namespace palpate {

// What a part of the trend is worth: its error over the JND (RMS) on folds left out, with
// it and without it.
struct FeatureWorth {
  std::string name;
  bool taken = false;
  double error_with = 0.0;
  double error_without = 0.0;
};

// What a regression of the trend is told besides its rows.
struct TrendProblem {
  double reference_depth_m = 0.0;
  double rms_velocity_m_per_s = 0.0;
  double force_noise_floor_N = 0.0;
  Weighting weighting = Weighting::jnd;
  JndLine jnd;
};

// The rows of the list's terms, at most so many, with their folds. Errors: those of the
// source; interrupted. `least_step_s`: samples sooner than this after the last are left out.
Result<TrendRows> gather_rows(MotionSource& source, const FoldDealer& dealer, const FeatureList& list,
                              const TrendProblem& problem, std::size_t most_rows, double least_step_s,
                              const FitControl& control, double fraction);

// `list` with the slowing and the surface that were found. Appends to `worth`.
Result<FeatureList> find_memory_law(MotionSource& source, const FoldDealer& dealer, const FeatureList& list,
                                    const TrendProblem& problem, std::vector<FeatureWorth>& worth,
                                    const FitControl& control, double fraction);

}  // namespace palpate
