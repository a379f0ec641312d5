// Whether the relaxation times of the material grow or shrink with depth (`slowing`,
// engine/tick/features.h): the one nonlinear parameter of the trend, from a coarse grid by
// cross-validation and the common rule (models/training/selection.h).
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "models/training/trend_dictionary.h"

namespace palpate {

// The gain of a part of the trend: the cross-validated error in JND (RMS) with it and without it.
struct PartGain {
  std::string name;
  bool taken = false;
  double error_with = 0.0;
  double error_without = 0.0;
};

// `list` with the slowing that was selected. Appends to `gains`. Errors: those of the source; interrupted.
Result<FeatureList> select_slowing(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                   std::vector<PartGain>& gains, const FitControl& control, double fraction);

}  // namespace palpate
