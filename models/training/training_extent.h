// What the rows of a training source span, measured in one pass.
// Thread guarantee: slow side.
#pragma once

#include <cstddef>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "models/training/fold_dealer.h"
#include "models/training/motion_source.h"

namespace palpate {

struct TrainingExtent {
  double depth_m = 0.0;
  double force_N = 0.0;
  double lowest_force_N = 0.0;        // of a material that pulls for certain, else 0
  double rms_velocity_m_per_s = 0.0;  // in contact
  std::size_t contact_samples = 0;
  std::size_t strokes = 0;
  double way_in_m = 0.0;  // in contact
  double way_out_m = 0.0;
  double sample_s = 0.0;  // the mean step
  double longest_recording_s = 0.0;

  // Whether the tool comes back in contact.
  bool turns_round() const;
};

FoldDealer dealer_for(const MotionSource& source, const TrainingExtent& extent);

// Errors: those of the source; interrupted.
Result<TrainingExtent> measure_extent(MotionSource& source, const FitControl& control);

// Where depth has to begin so that the force begins at 0, m; 0 where that is at the zero of
// positions already, or cannot be told. Many rigs count depth from a preload. The straight line
// through what is shallower than a hundredth of the greatest depth has its zero there; it is
// believed where its force at the zero of positions is one that a hand notices, and that and
// its slope are beyond two of their standard errors. Not farther out than the recordings go in.
// Errors: those of the source; interrupted.
Result<double> find_beginning(MotionSource& source, const TrainingExtent& extent, const JndLine& jnd,
                              const FitControl& control);

}  // namespace palpate
