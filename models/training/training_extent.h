// The ranges of the training data, measured in one pass.
// Thread guarantee: slow side.
#pragma once

#include <cstddef>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "models/training/cross_validation.h"
#include "models/training/motion_source.h"

namespace palpate {

struct TrainingExtent {
  double depth_m = 0.0;               // greatest
  double force_N = 0.0;               // largest
  double lowest_force_N = 0.0;        // < 0 if the material is known to pull (adhesion), else 0
  double rms_velocity_m_per_s = 0.0;  // in contact
  std::size_t contact_samples = 0;
  std::size_t strokes = 0;
  double loading_path_m = 0.0;    // path of the tool in contact, loading
  double unloading_path_m = 0.0;  // the same, unloading
  double sample_s = 0.0;          // mean sampling period
  double longest_recording_s = 0.0;

  // The folds of cross-validation. With one recording they are strokes or pieces of them.
  FoldAssignment folds(std::size_t recordings) const;
};

// Errors: those of the source; interrupted.
Result<TrainingExtent> measure_extent(MotionSource& source, const FitControl& control);

// The surface position in m, <= 0, of recordings whose depth counts from a preload; 0 where there is none or it cannot
// be identified. A straight line is fitted to the samples whose depth is below a hundredth of the greatest; the
// surface is where it has no force. The line is used if its force at position 0 exceeds the JND and two standard
// errors, its slope exceeds two standard errors, and the surface is nearer than the greatest depth.
// Errors: those of the source; interrupted.
Result<double> find_preload_surface(MotionSource& source, const TrainingExtent& extent, const JndLine& jnd,
                                    const FitControl& control);

}  // namespace palpate
