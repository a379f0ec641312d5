#include "scenes/live/session_models.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "models/model/fitted_model.h"
#include "models/samples/samples.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/worker/model_worker.h"

namespace palpate {

bool ModelTest::update(const SessionModels& models) {
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    take(running_.get());
    ++results_;
    complete_ = models.all_settled() && ready_ == models.ready_models();
    return true;
  }
  const Models ready = models.ready_models();
  const bool settled = models.all_settled();
  if (ready.empty() || (ready == ready_ && (complete_ || !settled))) return false;
  Models untested;
  std::ranges::copy_if(ready, std::back_inserter(untested),
                       [&](const auto& one) { return find(one.get()) == nullptr; });
  complete_ = false;
  ready_ = ready;
  try {
    running_ = std::async(std::launch::async, [this, untested, timed = settled ? ready : untested] {
      lower_thread_priority();
      return run(untested, timed);
    });
  } catch (const std::system_error&) {
    // Without a thread there are no results; the errors are those of the ticks.
  }
  return false;
}

ModelTest::Outcome ModelTest::run(const Models& untested, const Models& timed) {
  const auto progress = [this](double) { return !cancelled_.load(std::memory_order_relaxed); };
  Outcome outcome;
  if (replay_ == nullptr && make_ != nullptr && !made_) {
    Result<Recording> made = make_(progress);
    if (!made) return outcome;
    made_ = std::move(*made);
  }
  const Recording* recording = replay_ != nullptr ? &replay_->recording() : made_ ? &*made_ : nullptr;
  if (recording != nullptr && !air_N_) air_N_ = prepare_recording(*recording)->surface.force_zero_N;
  outcome.force_zero_N = air_N_.value_or(0.0);
  if (recording == nullptr) {
    for (const auto& model : untested) outcome.tested.push_back({model, {}, {}, {}});
  } else if (!untested.empty()) {
    std::vector<EvaluatedModel> evaluated;
    for (const auto& model : untested) evaluated.push_back({model, jnd_});
    EvaluationRequest request;
    request.control.progress = progress;
    request.move_surface = replay_ != nullptr;
    request.force_zero_N = outcome.force_zero_N;
    auto result = evaluate(*recording, evaluated, request);
    if (!result) return outcome;
    const auto errors_of = [](const ModelErrors& errors) -> Errors {
      const UnitErrors of_units = errors.unit_errors();
      return {of_units, of_units.p99_interval(), of_units.drawn_strokes};
    };
    for (std::size_t i = 0; i < untested.size(); ++i) {
      const auto& one = result->models[i];
      outcome.tested.push_back({untested[i], errors_of(one.as_recorded), errors_of(one.surface_moved), {}});
    }
    samples_ = std::move(result->timing);
  }
  if (replay_ != nullptr) {
    const Recording zeroed = with_force_zero(*recording, outcome.force_zero_N);
    outcome.surface = locate_surface(thinned_rows(zeroed, kSearchRows), timed, jnd_);
  }
  outcome.timed = timed;
  for (const ModelTiming& timing : time_models(timed, samples_)) outcome.ticks.push_back(timing.tick);
  return outcome;
}

void ModelTest::take(Outcome outcome) {
  for (Tested& one : outcome.tested) tested_.push_back(std::move(one));
  std::erase_if(tested_, [&](const Tested& one) { return std::ranges::count(ready_, one.model) == 0; });
  for (Tested& one : tested_) {
    const auto at = std::ranges::find(outcome.timed, one.model);
    if (at != outcome.timed.end()) one.tick = outcome.ticks[static_cast<std::size_t>(at - outcome.timed.begin())];
  }
  if (outcome.timed == ready_) surface_ = outcome.surface;
  force_zero_N_ = outcome.force_zero_N;
}

const ModelTest::Tested* ModelTest::find(const ForceModel* model) const noexcept {
  const auto found = std::ranges::find_if(tested_, [&](const Tested& one) { return one.model.get() == model; });
  return found == tested_.end() ? nullptr : &*found;
}

bool ModelTest::move(bool moved) {
  moved_ = moved;
  if (replay_ == nullptr || replay_->surface_offset_m() == offset_m()) return false;
  replay_->move_surface(offset_m());
  return true;
}

}  // namespace palpate
