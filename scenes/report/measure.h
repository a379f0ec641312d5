// Every measurement of the report: fits, errors, times, and the choice of a model.
//
// The model is chosen on training that was left out of the fits, before anything is tested:
// of several recordings every third one, of a single one a block at its end. Of one or two
// strokes nothing can be left out; then the test chooses, and the page says so.
// Thread guarantee: slow side; the fits start threads themselves.
#pragma once

#include "engine/base/fit_control.h"
#include "scenes/report/recordings.h"
#include "scenes/report/report_data.h"
#include "scenes/scene/scene.h"

namespace palpate {

// Training again, with a part left out.
struct LeftOut {
  std::vector<SharedRecording> train;
  std::vector<SharedRecording> tested;
  Interval counted_s{-1e300, 1e300};  // what came before it is replayed too, for the material remembers
  std::string words;                  // "the last 40 % of the training recording, one block"
};
// Nothing to test on where nothing can be left out.
LeftOut leave_out(const std::vector<SharedRecording>& training);

// Errors: those of the recordings and the fits, with the recordings' names; interrupted.
// The same recordings and plan give the same figures but for times. With several folds
// every model is fitted once a fold and its errors are taken together.
Result<ReportData> measure(const RecordingSet& recordings, const Scene& scene, bool quick, const FitControl& control);

}  // namespace palpate
