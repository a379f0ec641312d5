// Makes the pair of strokes for a discrimination study from a recording and one or two models.
// Every row of the recording goes through the tick of the live loop (engine/tick/replay.h). The forces of models and
// sensor are resampled to 1 kHz and filtered with the same zero-phase low-pass, a Hann window of 21 ms (half the
// amplitude at 45 Hz), because the noise of the sensor would make its stroke recognisable. A piece has the length of an
// interval (study_presenter.h) and begins at a multiple of 100 ms. The piece with the largest sum of error / JND is
// chosen among those up to 3.8 N and 90 N/s (below the presenter's limits) and 2.5 N RMS (the heat of a small motor).
// The force over time is rendered to a still hand. The hand does not influence it, so this tests the discrimination
// of forces, as the JND study does.
// Thread guarantee: slow side (fits models, does I/O, allocates).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/tick/force_model.h"
#include "scenes/study/study_file.h"

namespace palpate {

// `scene`: name of a scene. `models`: methods, fitted as by `palpate fit`, or model files. Two: the reference and the
// comparison. One: the comparison; the recorded force is the reference. None: as one, the first default model of the
// scene. `recording`: the file to render, to which no model was fitted; empty: a recording of the scene's virtual
// material with seed 2.
// Errors: more than two models; those of load_scene, of requested_models, of the fits and of the recording; neither
// recording nor virtual material; no piece within the limits.
Result<std::shared_ptr<const StrokePair>> prepare_strokes(const std::string& scene,
                                                          const std::vector<std::string>& models,
                                                          const std::string& recording);

// The same for ready models; `reference` null: the recorded force.
Result<std::shared_ptr<const StrokePair>> strokes_of(const Recording& recording,
                                                     const std::shared_ptr<const ForceModel>& reference,
                                                     const std::shared_ptr<const ForceModel>& comparison,
                                                     const JndLine& jnd);

}  // namespace palpate
