// Models against test recordings: every sample goes through the tick of the live
// loop, sixteen models at a time.
//
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <memory>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/tick/force_model.h"
#include "scenes/report/data/recordings.h"
#include "scenes/report/data/report_data.h"

namespace palpate {

inline constexpr Interval kAlways{-1e300, 1e300};  // seconds

using ModelPointer = std::shared_ptr<const ForceModel>;

// Errors of some models, recording by recording and together. The same models in the
// same order every time, from one fold to the next.
class ReplayEvaluator {
 public:
  ReplayEvaluator(std::size_t models, const JndLine& jnd) : jnd_(jnd), pooled_(models, StrokeErrors(jnd)) {}

  // One each per model for this recording, which also counts in `pooled`. What lies outside
  // of `counted` is replayed, since the material remembers it, but does not count. Errors:
  // interrupted.
  Result<std::vector<Evidence>> evaluate(const Recording& recording, const std::vector<ModelPointer>& models,
                                         const FitControl& control = {}, const Interval& counted = kAlways);

  std::vector<Evidence> pooled() const;

 private:
  JndLine jnd_;
  std::vector<StrokeErrors> pooled_;
};

}  // namespace palpate
