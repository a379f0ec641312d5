// Every measurement of the report: fits, errors, times.
//
// Thread guarantee: slow side; the fits start threads themselves.
#pragma once

#include "engine/base/fit_control.h"
#include "scenes/report/data/plan.h"
#include "scenes/report/data/recordings.h"
#include "scenes/report/data/report_data.h"
#include "scenes/scene/scene.h"

namespace palpate {

// Errors: those of the recordings and the fits, with the recordings' names; interrupted.
// The same recordings and plan give the same figures but for times. With several
// folds every model is fitted once a fold and its errors are taken together.
Result<ReportData> run_methods(const RecordingSet& recordings, const Scene& scene, const ReportPlan& plan,
                               const FitControl& control = {});

}  // namespace palpate
