// Errors on training strokes that were left out of the fit: what a recommendation is
// made on before anything is tested.
//
// The surface of every recording is found once, from all of the training: a part of a
// recording says less of it (it may begin on a dent that the last press left), and one
// number a recording tells a model nothing of a stroke.
// Thread guarantee: slow side; the fits start threads themselves.
#pragma once

#include <vector>

#include "scenes/report/data/plan.h"
#include "scenes/report/data/recordings.h"
#include "scenes/report/measure/weighted_progress.h"
#include "scenes/scene/scene.h"

namespace palpate {

// A stretch of a recording; what came before it is replayed too, for the material remembers.
struct LeftOutPart {
  SharedRecording recording;
  Interval seconds;
};

// Training recordings again, with strokes left out: of two and more recordings whole ones,
// of a single one the last two fifths or the first.
struct LeftOutFold {
  std::vector<SharedRecording> train;
  std::vector<LeftOutPart> left_out;
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
