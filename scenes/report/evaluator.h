// Models against test recordings: every sample goes through the tick of the live
// loop, sixteen models at a time.
//
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <memory>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/tick/force_model.h"
#include "scenes/report/recordings.h"
#include "scenes/report/report_data.h"

namespace palpate {

using ModelPointer = std::shared_ptr<const ForceModel>;

// Errors of some models, recording by recording and together. The same models in the
// same order every time, from one fold to the next.
class ReplayEvaluator {
 public:
  ReplayEvaluator(std::size_t models, const JndLine& jnd) : jnd_(jnd), pooled_(models, StrokeErrors(jnd)) {}

  // One each per model for this recording, which also counts in `pooled`. Errors:
  // interrupted.
  Result<std::vector<Evidence>> evaluate(const Recording& recording, const std::vector<ModelPointer>& models,
                                         const FitControl& control = {});

  std::vector<Evidence> pooled() const;

 private:
  JndLine jnd_;
  std::vector<StrokeErrors> pooled_;
};

}  // namespace palpate
