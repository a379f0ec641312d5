// A thread that makes the models of a session ready, the quickest first: methods are fitted
// to the recordings that are the material, or to what `palpate synth` writes of the scene's with the same
// seed; the same bits as of `palpate fit`.
// Asked for another number of centres than before (a slider), it chooses centres for the largest number
// once; each number after that takes milliseconds (models/fit/nested_fit.h).
// It runs at a lower priority than everything else. A fit is interrupted within some 20 ms, but for the
// factorisation of the direct fit, which is one call into LAPACK.
// Thread guarantee: one thread, slow side; nothing but the destructor waits for the worker.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "models/fit/fit.h"
#include "models/fit/nested_fit.h"
#include "models/model/fitted_model.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/slot_plan.h"

namespace palpate {

struct FinishedModel {
  std::size_t job_id = 0;  // as asked for
  SlotPlan plan;
  std::shared_ptr<const FittedModel> model;  // null: `problem` says why
  std::string problem;
  Timing tick;  // a whole one of this model alone
};

// A model that is there already.
FinishedModel finished_model(std::size_t job_id, const SlotPlan& plan, std::shared_ptr<const FittedModel> model);

// For threads that must never hold up graphics or haptics: of this thread and those
// that it will start.
void lower_thread_priority() noexcept;

class ModelWorker {
 public:
  ModelWorker(Scene scene, std::uint64_t seed);
  ModelWorker(const ModelWorker&) = delete;
  ModelWorker& operator=(const ModelWorker&) = delete;
  // Interrupts what is being made and waits for the worker.
  ~ModelWorker();

  // The model of one plan, now and in this thread; before `start`. Errors: those of the fit; a scene without
  // a material to fit to.
  Result<std::shared_ptr<const FittedModel>> make(const SlotPlan& plan);

  // What is asked for before this is made the quickest first. Errors: no thread.
  Status start();
  // One that is asked for again before it was begun is made once, as asked last. `at_once`: before all others.
  void add_job(std::size_t job_id, const SlotPlan& plan, bool at_once = false);
  // What was finished since the last call.
  std::vector<FinishedModel> read_finished();

  struct Progress {
    bool working = false;
    std::size_t job_id = 0;
    double share = 0.0;  // of this one
  };
  Progress progress() const;

  // Interrupts the fit that runs; no other is begun. Does not wait.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }

 private:
  struct Job {
    std::size_t job_id = 0;
    SlotPlan plan;
    double cost_s = 0.0;  // expected; below 0: at once
  };
  void work();  // until cancelled
  Result<ModelData> fit(const SlotPlan& plan);
  Result<MethodFit> fit_nested(const PreparedTraining& prepared, const MethodRequest& request, bool paper,
                               const FitControl& control);
  Status prepare_recordings();
  Status prepare(std::optional<PreparedTraining>& prepared, const TrainingRequest& request);
  FitControl control(double from, double to);

  Scene scene_;
  std::uint64_t seed_;
  // The worker's own.
  std::vector<MotionSource::Input> recordings_;
  std::optional<PreparedTraining> prepared_;
  std::optional<PreparedTraining> prepared_as_paper_;
  std::map<const Method*, MethodFit> bases_;  // fitted already, for methods that start from one
  // By method and recipe: empty from the first fit on, filled by the second.
  std::map<std::pair<const Method*, bool>, std::optional<NestedFit>> nested_;

  std::thread thread_;
  std::atomic<bool> cancelled_{false};
  std::atomic<double> share_{0.0};
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // By mutex_.
  std::deque<Job> jobs_;
  std::vector<FinishedModel> finished_;
  std::optional<std::size_t> working_on_;
};

// For programs without a word of models, at the beginning of main: models/linear/lapack.h.
void prepare_to_fit();

}  // namespace palpate
