// How a material's memory runs, decided before its features are: whether its
// relaxation times grow with the depth (`slowing`) and whether its surface leaves the
// tool (engine/tick/features.h).
//
// The trend with a coarse ladder of relaxation times is fitted with each answer and
// scored on strokes left out (cross_validated_trend.h). The surface follows from the
// fitted trend itself, so that answer takes a second fit, whose branches follow the
// surface of the first. An answer other than "constant times, surface under the tool"
// must lower the error by more than one standard error of the differences between the
// folds, and by more than some per cent.
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/training/fold_dealer.h"
#include "models/training/feature_selection.h"
#include "models/training/motion_source.h"
#include "models/training/trend_rows.h"

namespace palpate {

struct MemoryLaw {
  double slowing = 0.0;
  std::vector<FeatureSpec> surface{};  // TrendTerms::surface
  std::vector<FeatureWorth> worth{}; // of the surface, of the slowing; empty when nothing was asked
};

// `ladder`: all relaxation times, thresholds and healing times that may be. Errors: those of the source; interrupted.
Result<MemoryLaw> find_memory_law(MotionSource& source, const FoldDealer& dealer, const SelectionInput& input,
                                  const TrendTerms& ladder, const FitControl& control, double fraction);

}  // namespace palpate
