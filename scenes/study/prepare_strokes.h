// From a recording and one or two models to the pair of strokes that a hand is to tell
// apart.
//
// Every row of the recording goes through the tick that the live loop runs
// (engine/tick/replay.h). What the models and the force sensor say is brought to one value
// per ms and passed through the same zero-phase low-pass, 21 ms of a Hann window (half
// the amplitude at 50 Hz): the sensor's noise is no force of the block, and told apart
// it would be at once. Taken is the piece, as long as an interval (study_presenter.h), in
// which the errors over the JND sum to most: the prediction is put to a hard test.
// Left out is what a study may not present (4 N, 100 N/s) or a small motor does not bear
// with the pauses (2.5 N, root mean square).
//
// A still hand is given the force over time. It does not move the tool, so this tests
// the discrimination of forces as the JND study does, whose thresholds the errors are
// held against, and neither hand nor model answers to the other.
// Thread guarantee: slow side (fits models, does I/O, allocates).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/tick/force_model.h"
#include "scenes/scene/scene.h"
#include "scenes/study/stroke_pair.h"

namespace palpate {

inline constexpr const char* kRecordedForce = "recorded force";

struct StrokeRequest {
  Scene scene;
  // Methods, fitted as the window and `palpate fit` do, or model files: the reference
  // and the comparison. With one the recorded force is the reference; none: the first
  // of the scene's, likewise.
  std::vector<std::string> models;
  // The recording to render, none that a model was fitted to. Empty: a virtual one of
  // the scene's material, seed 2.
  std::string recording;
};

// Errors: more than two models; those of plan_slots, of the fits, of the recording; no
// recording and no material; no stroke that can be presented.
Result<std::shared_ptr<const StrokePair>> prepare_strokes(const StrokeRequest& request);

// The same for models that are ready; `reference` null: the recorded force.
Result<std::shared_ptr<const StrokePair>> strokes_of(const Recording& recording,
                                                     const std::shared_ptr<const ForceModel>& reference,
                                                     const std::shared_ptr<const ForceModel>& comparison,
                                                     const JndLine& jnd);

}  // namespace palpate
