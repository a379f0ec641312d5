// The models that a session is asked for (plans that are fitted to the scene's material, and model files), and the
// thread that fits them in the background, those of the least expected time first. The training set is given, or the
// recording that `palpate synth` makes of the scene's virtual material with the same seed. The models are bit-identical
// to those of `palpate fit`. The thread has a lower priority than graphics and haptics. A fit is interrupted within
// some 20 ms, except during the factorisation of the direct fit, which is one call to LAPACK. Thread guarantee: one
// thread, slow side; only the destructor waits for the thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "models/fit/fit.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The largest number of centres of the slider.
inline constexpr int kMostCentres = 200;

struct ModelRequest {
  ModelPlan plan;
  std::string path{};                                   // of a file; empty: the plan is fitted
  std::shared_ptr<const FittedModel> loaded = nullptr;  // the model, if it exists already; requested_models reads files
  bool of_this_material = false;                        // a file counts as this material, whatever its recordings

  bool is_file() const { return !path.empty(); }
};

struct LineUp {
  const char* name;
  const char* help;  // one line
  std::vector<std::string> models;
};
// All line-ups; the first is the default of a window, of the report's first table and of the main job.
const std::vector<LineUp>& line_ups();
const LineUp* find_line_up(const std::string& name);

// Models with differences from obvious to unnoticeable, for the game of the exhibit.
const std::vector<std::string>& exhibit_models();

// A method that a user may add to the comparison.
struct MethodChoice {
  std::string family;        // "trend+greedy"
  std::vector<int> centres;  // the numbers to choose from; 0: it takes none
};
const std::vector<MethodChoice>& method_choices();

// The name of a model until it is ready.
std::string request_name(const ModelRequest& request);

// Makes requests from `models`, names of models or model files; empty: the first line-up. Model files are read.
// Errors: neither a model nor a file, a file that load_model refuses, a plan in a scene without a material, more than
// kMaxModels models.
Result<std::vector<ModelRequest>> requested_models(const Scene& scene, const std::vector<std::string>& models);

struct FinishedModel {
  std::size_t job_id = 0;
  int centres = 0;  // of its plan
  Result<std::shared_ptr<const FittedModel>> model;
};

// Lowers the priority of this thread, and of those that it starts later, below graphics and haptics.
void lower_thread_priority() noexcept;

class ModelWorker {
 public:
  // `training`: recordings; empty: that of the scene's virtual material. `ready`: the folder of make_ready_models,
  // whose models of that material need no fit; may be empty.
  ModelWorker(Scene scene, std::uint64_t seed, std::vector<Recording> training = {}, const std::string& ready = "");
  // Interrupts the running fit and waits for the thread.
  ~ModelWorker() { cancel(); }

  // Makes the model of one request in the calling thread; call it before `start`. Errors: those of the fit; the scene
  // has no material to fit to.
  Result<std::shared_ptr<const FittedModel>> make(const ModelRequest& request);

  // The file of a ready model of this plan; empty: there is none for this scene and seed.
  std::string ready_file(const ModelPlan& plan) const;

  // Errors: a thread cannot be started.
  Status start();
  // Adds a job to the queue, which is in the order of expected times. A job of the same id that has not begun is
  // replaced. `at_once`: before all others.
  void add_job(std::size_t job_id, const ModelRequest& request, bool at_once = false);
  // Returns and clears the models that were finished since the last call.
  std::vector<FinishedModel> read_finished();

  // Takes a job out of the queue, or interrupts it.
  void cancel_job(std::size_t job_id);

  struct Progress {
    std::size_t job_id = 0;
    double share = 0.0;  // of this job, 0..1
  };
  // Of the running job; empty: none runs.
  std::optional<Progress> progress() const;
  // Estimated time until all jobs are done. It grows only with a new job.
  double left_s() const;

  // Interrupts the running fit and starts no other. Does not wait.
  void cancel() noexcept { stop_.request_stop(); }

 private:
  struct Job {
    std::size_t job_id = 0;
    ModelRequest request;
  };
  void work();  // until cancelled
  double expected_cost_s(const ModelRequest& request) const;
  Status prepare_recordings();
  FitControl control(double from, double to);

  Scene scene_;
  std::uint64_t seed_;
  std::string ready_;  // folder of the ready models of this scene and seed; empty: there are none
  std::stop_source stop_;
  // Used by the thread only.
  std::vector<Recording> training_;  // until the first fit
  std::optional<ModelFits> fits_;    // none before the first fit
  std::atomic<double> share_{0.0};
  std::atomic<bool> interrupted_{false};  // the running job was cancelled
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  // Guarded by mutex_.
  std::vector<FinishedModel> finished_;
  std::multimap<double, Job> jobs_;  // by expected time, s; below 0: at once
  std::optional<std::size_t> working_on_;
  double began_s_ = 0.0;                         // of the running job; steady clock
  double expected_s_ = 0.0;                      // its expected duration
  double done_s_ = 0.0, done_expected_s_ = 0.0;  // of all jobs before
  mutable double end_s_ = 0.0;                   // the earliest end of all jobs that was estimated; 0: none
  std::jthread thread_;                          // last: it ends before what it uses
};

// Fits the models with which a window of this scene may start, with seed 1, when the program is built
// (ready_models_main.cpp):
//   FOLDER/SCENE/NAME.json    a model, as `palpate fit` writes it
//   FOLDER/SCENE/inputs.txt   what the fits depend on, beside the program itself, on which their build depends
// Errors: those of load_scene, the fits and save_model; the folder cannot be created.
Status make_ready_models(const std::string& folder, const std::string& scene);

// Calls prepare_blas (models/linear/lapack.h), for programs that may not include models/. Call it first in main.
void prepare_to_fit();

}  // namespace palpate
