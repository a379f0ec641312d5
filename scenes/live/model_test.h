// Tests the ready models of a session behind the scenes: their errors over a whole recording that no model was fitted
// to, as `palpate replay` and the report compute them (scenes/evaluation/evaluate.h), and the time of their ticks. The
// result does not depend on what the user presses. The recording is the one that is replayed, a part of the training
// recording that was set apart, or that of the scene's material with another seed.
// Of a replayed recording, it also estimates one surface offset for all models together, which the user can apply.
// A separate thread tests each model when it becomes ready, and times all models together when all fits have ended, so
// that a slow phase of the machine affects all of them.
// Thread guarantee: one thread; only the destructor waits, some tenths of a second.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "engine/live/device.h"
#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate {

class SessionModels;

class ModelTest {
 public:
  using Models = std::vector<std::shared_ptr<const ForceModel>>;
  // Makes the recording, in the thread of the test. `progress`: see record_sensors.
  using MakeRecording = std::function<Result<Recording>(const std::function<bool(double)>& progress)>;

  // `replay` outlives this; null: nothing is replayed. Without a replay and without `make` models are only timed.
  ModelTest(ReplayControl* replay, MakeRecording make, const JndLine& jnd)
      : replay_(replay), make_(std::move(make)), jnd_(jnd) {}
  ~ModelTest() { cancelled_.store(true, std::memory_order_relaxed); }

  // Whether there is a recording to test on.
  bool has_recording() const noexcept { return replay_ != nullptr || make_ != nullptr; }
  // Call it once a frame. Returns whether there are new results.
  bool update(const SessionModels& models);
  // Whether the newest results are those of all ready models, timed together.
  bool complete() const noexcept { return complete_; }
  // The recording of the tests; null: there is none, or a test is running.
  const Recording* recording() const noexcept {
    if (running_.valid()) return nullptr;
    return replay_ != nullptr ? &replay_->recording() : made_ ? &*made_ : nullptr;
  }
  // Number of tests with results.
  std::uint64_t results() const noexcept { return results_; }

  struct Errors : ErrorSummary {
    Interval p99_interval{kUnknown, kUnknown};
    Draws strokes;  // for the choice of the best model
  };
  struct Tested {
    std::shared_ptr<const ForceModel> model;
    Errors as_recorded, surface_moved;  // without samples if there is no recording
    Timing tick;                        // a whole tick with this model alone
  };
  const Tested* find(const ForceModel* model) const noexcept;
  // Its errors with the surface as it is now (`moved`). `tested`: of this object.
  const Errors& errors(const Tested& tested) const noexcept {
    return moved_ ? tested.surface_moved : tested.as_recorded;
  }

  // Whether to subtract the estimated offset from the positions of the replay. Returns whether that changes them.
  bool move(bool moved);
  bool moved() const noexcept { return moved_; }
  double found_m() const noexcept { return surface_.at; }  // estimated offset; 0: none yet, or not significant
  double offset_m() const noexcept { return moved_ ? found_m() : 0.0; }  // that is subtracted

 private:
  struct Outcome {
    std::vector<Tested> tested;  // of the new models
    Models timed;
    std::vector<Timing> ticks;  // of `timed`
    OffsetEstimate surface;
  };
  Outcome run(const Models& untested, const Models& timed);
  void take(Outcome outcome);

  ReplayControl* replay_;
  MakeRecording make_;
  JndLine jnd_;
  bool moved_ = false, complete_ = false;
  std::uint64_t results_ = 0;
  Models ready_;  // of the last test
  std::vector<Tested> tested_;
  OffsetEstimate surface_;
  // The thread of the test only.
  std::optional<Recording> made_;
  std::vector<TimedSamples> samples_;  // to time models on; none without a recording
  std::atomic<bool> cancelled_{false};
  std::future<Outcome> running_;
};

}  // namespace palpate
