// Which features a recording supports (`--features auto`).
//
// Candidates, each with the trend terms that go with it (models/model/trend.h):
//   velocity           viscosity
//   relaxation         a ladder of times, kTimesPerDecade to a decade, from two
//                      samples to a third of the recording (1 ms to 100 s at
//                      most), non-negative; in three bands (fast, middle, slow),
//                      each of which becomes one feature, the sum of its branches
//   stops              a ladder of thresholds: dry friction, hysteresis
//   fading peak        the deepest depth with one of several healing times
// For given times and thresholds the trend is linear in its coefficients, which are
// never negative, so all candidate columns are filtered in one pass and every set
// of candidates is a small non-negative least-squares problem on a part of one
// Gram matrix per fold (Lawson & Hanson 1974). A set is scored by the error of
// (f - T) / JND on the folds left out (fold_dealer.h); samples deeper than
// anything in the other folds do not count, for there only the guess would.
//
// Forward selection, then backward: the smallest set whose error is within one
// standard error (of the differences between the folds) of the best set's
// (Breiman et al. 1984, section 3.4.3; Hastie, Tibshirani & Friedman 2009,
// section 7.10).
// Thread guarantee: slow side.
#pragma once

#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "models/training/feature_list.h"
#include "models/training/fold_dealer.h"
#include "models/training/motion_source.h"
#include "models/training/trend_rows.h"
#include "models/training/weighting.h"

namespace palpate {

// What one candidate is worth: the cross-validated error of the trend, over the
// JND, with the features taken, and with this one taken away or added.
struct FeatureWorth {
  std::string name;
  bool taken = false;
  double error_with = 0.0;
  double error_without = 0.0;
};

struct FeatureSelection {
  FeatureList list;
  std::vector<FeatureWorth> worth;   // in the order of the features, then what was not taken
  // Whether the tool turns round in contact: a single way in cannot tell memory from
  // elasticity, and gets the depth alone.
  bool turns_round = false;
  double shortest_s = 0.0;  // of the ladder of relaxation times
  double longest_s = 0.0;
  double training_error_over_jnd = 0.0;
  double left_out_error_over_jnd = 0.0;
};

struct SelectionInput {
  double reference_depth_m = 0.0;
  double rms_velocity_m_per_s = 0.0;
  double force_floor_N = 0.0;  // at or below it there is no measured force
  bool turns_round = true;     // the tool comes back in contact
  Weighting weighting = Weighting::jnd;
  JndLine jnd;
};

// Errors: those of the source; interrupted.
Result<FeatureSelection> select_features(MotionSource& source, const FoldDealer& dealer, const SelectionInput& input,
                                         const FitControl& control, double fraction);

}  // namespace palpate
