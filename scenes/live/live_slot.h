// A slot of a live session: what the window sees of it and what is behind.
// Internal to scenes/live.
#pragma once

#include <memory>

#include "models/model/fitted_model.h"
#include "scenes/live/dent.h"
#include "scenes/live/evaluation_time.h"
#include "scenes/live/live_session.h"
#include "scenes/worker/slot_plan.h"

namespace palpate {

struct LiveSession::Slot {
  SlotView view;
  SlotPlan plan;
  std::shared_ptr<const FittedModel> model;  // null until ready
  EvaluationTime time;
  Dent dent;
  double late_error_over_jnd = 0.0;  // in the last snapshot; 0 without a comparison
};

}  // namespace palpate
