#include "scenes/live/replay_test.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "models/model/fitted_model.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/live/session_models.h"
#include "scenes/worker/model_worker.h"

namespace palpate {

bool ReplayTest::update(const SessionModels& models) {
  if (replay_ == nullptr) return false;
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    found_ = running_.get();
    ++rounds_;
    return apply();
  }
  if (!requested_.empty() && !models.all_settled()) return false;
  std::vector<std::shared_ptr<const ForceModel>> ready;
  for (const std::size_t slot : models.ready_slots()) ready.push_back(models.model(slot));
  if (ready.empty() || ready == requested_) return false;
  requested_ = ready;
  try {
    running_ = std::async(std::launch::async, [this, ready = std::move(ready)] {
      lower_thread_priority();
      return run(ready);
    });
  } catch (const std::system_error&) {
    // Without a thread, positions stay as recorded, and the errors are those of the ticks.
  }
  return false;
}

ReplayTest::Outcome ReplayTest::run(const std::vector<std::shared_ptr<const ForceModel>>& models) const {
  Outcome outcome;
  outcome.surface = locate_surface(thinned_rows(replay_->recording(), kSearchRows), models, jnd_);
  std::vector<EvaluatedModel> evaluated;
  for (const auto& model : models) evaluated.push_back({model, jnd_});
  EvaluationRequest request;
  request.control.progress = [this](double) { return !cancelled_.load(std::memory_order_relaxed); };
  const auto result = evaluate(rows_of(replay_->recording()), evaluated, request);
  if (!result) return outcome;
  for (std::size_t i = 0; i < models.size(); ++i)
    outcome.models.push_back(
        {models[i], result->models[i].as_recorded.unit_errors(), result->models[i].surface_moved.unit_errors()});
  return outcome;
}

const ReplayTest::Tested* ReplayTest::find(const ForceModel* model) const noexcept {
  const auto found = std::find_if(found_.models.begin(), found_.models.end(),
                                  [&](const Tested& one) { return one.model.get() == model; });
  return found == found_.models.end() ? nullptr : &*found;
}

const UnitErrors* ReplayTest::errors(const ForceModel* model) const noexcept {
  const Tested* tested = find(model);
  if (tested == nullptr) return nullptr;
  return moved_ ? &tested->surface_moved : &tested->as_recorded;
}

const UnitErrors* ReplayTest::as_recorded(const ForceModel* model) const noexcept {
  const Tested* tested = find(model);
  return tested == nullptr ? nullptr : &tested->as_recorded;
}

bool ReplayTest::move(bool moved) {
  moved_ = moved;
  return replay_ != nullptr && apply();
}

bool ReplayTest::apply() {
  if (replay_->surface_offset_m() == offset_m()) return false;
  replay_->move_surface(offset_m());
  return true;
}

}  // namespace palpate
