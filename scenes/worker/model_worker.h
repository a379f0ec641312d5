// A background thread that fits the models of a session, those of the least expected time first. The training set is
// the scene's recordings, or the recording that `palpate synth` makes of its virtual material with the same seed.
// The models are bit-identical to those of `palpate fit`.
// The thread has a lower priority than graphics and haptics. A fit is interrupted within some 20 ms, except during the
// factorisation of the direct fit, which is one call to LAPACK.
// Thread guarantee: one thread, slow side; only the destructor waits for the worker.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "models/fit/model_fits.h"
#include "models/model/fitted_model.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/model_request.h"

namespace palpate {

struct FinishedModel {
  std::size_t job_id = 0;
  int centres = 0;  // of its plan
  Result<std::shared_ptr<const FittedModel>> model;
  Timing tick;  // a whole tick with this model alone
};

// Times the tick on one second of strokes within the model's training domain, which takes some milliseconds.
Timing time_of_tick(const std::shared_ptr<const FittedModel>& model);

// Lowers the priority of this thread, and of those that it starts later, below graphics and haptics.
void lower_thread_priority() noexcept;

class ModelWorker {
 public:
  ModelWorker(Scene scene, std::uint64_t seed);
  ModelWorker(const ModelWorker&) = delete;
  ModelWorker& operator=(const ModelWorker&) = delete;
  // Interrupts the running fit and waits for the worker.
  ~ModelWorker();

  // Makes the model of one request in the calling thread; call it before `start`. Errors: those of the fit; the scene
  // has no material to fit to.
  Result<std::shared_ptr<const FittedModel>> make(const ModelRequest& request);

  // Errors: the thread cannot be started.
  Status start();
  // Adds a job to the queue, which is in the order of expected times. A job of the same id that has not begun is
  // replaced. `at_once`: before all others.
  void add_job(std::size_t job_id, const ModelRequest& request, bool at_once = false);
  // Returns and clears the models that were finished since the last call.
  std::vector<FinishedModel> read_finished();

  struct Progress {
    bool working = false;
    std::size_t job_id = 0;
    double share = 0.0;  // of this job, 0..1
  };
  Progress progress() const;

  // Interrupts the running fit and starts no other. Does not wait.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }

 private:
  struct Job {
    std::size_t job_id = 0;
    ModelRequest request;
  };
  void work();  // until cancelled
  Result<ModelData> fit(const ModelPlan& plan);
  Status prepare_recordings();
  FitControl control(double from, double to);

  Scene scene_;
  std::uint64_t seed_;
  std::optional<ModelFits> fits_;  // used by the worker's thread only; none before the first fit

  std::thread thread_;
  std::atomic<bool> cancelled_{false};
  std::atomic<double> share_{0.0};
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_.
  std::multimap<double, Job> jobs_;  // by expected time, s; below 0: at once
  std::vector<FinishedModel> finished_;
  std::optional<std::size_t> working_on_;
};

// Calls prepare_blas (models/linear/lapack.h), for programs that may not include models/. Call it first in main.
void prepare_to_fit();

}  // namespace palpate
