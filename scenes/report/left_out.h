// Errors on training strokes that were left out of the fit: what a recommendation is
// made on before anything is tested.
//
// The surface of every recording is found once, from all of the training: a part of a
// recording says less of it (it may begin on a dent that the last press left), and one
// number a recording tells a model nothing of a stroke.
// Thread guarantee: slow side; the fits start threads themselves.
#pragma once

#include <vector>

#include "scenes/report/plan.h"
#include "scenes/report/recordings.h"
#include "scenes/report/weighted_progress.h"
#include "scenes/scene/scene.h"

namespace palpate {

// Training recordings again, with strokes left out: of three and more recordings whole
// ones, of one or two every other part of them.
struct LeftOutFold {
  std::vector<SharedRecording> train;
  std::vector<SharedRecording> left_out;
};

// Up to `most` folds of `training`; none where nothing can be left out.
std::vector<LeftOutFold> left_out_folds(const std::vector<SharedRecording>& training, int most);

// The training with every recording moved to where a fit to all of it found its surface.
std::vector<SharedRecording> at_own_surfaces(const std::vector<SharedRecording>& training,
                                             const Provenance& provenance);

// One for each planned model; without samples where it is no candidate or nothing could
// be left out. `training`: at_own_surfaces. Errors: interrupted.
Result<std::vector<Evidence>> left_out_errors(const std::vector<SharedRecording>& training, const Scene& scene,
                                              const ReportPlan& plan, WeightedProgress& progress);

}  // namespace palpate
