// A live session without a window: a scene, a device, the haptics loop, the models (SessionModels), their errors
// against a reference tick by tick (Comparison) and over a test recording (ModelTest), the verdict, the recorder and
// the fault log. The reference is the measured force, else the true force of the scene's virtual material, else a
// model. Thread guarantee: one thread (the window's). While the session runs, neither it nor the haptics thread waits
// for the other; `open` and the destructor block.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/bridge/bridge_bus.h"  // allow_remote_bridges
#include "devices/registry/device_registry.h"
#include "engine/base/result.h"
#include "engine/live/haptics_loop.h"
#include "engine/tick/jnd.h"
#include "scenes/live/comparison.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/session_models.h"
#include "scenes/live/session_recorder.h"
#include "scenes/live/verdict.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/model_worker.h"

namespace palpate {

struct SessionRequest {
  std::string scene{};  // empty: silicone_block, or with model files only the scene that the first was fitted for
  // Training set of the models. Empty: the recording that the device replays, else the scene's virtual material.
  std::vector<std::string> recordings{};
  // The recording that models are tested on. Empty: the one that the device replays, else the last training recording,
  // else that of the scene's virtual material with another seed. The last part of a recording that is in the training
  // set as well is set apart for the test, if models are fitted to the rest or were (this names it).
  std::string test{}, device = "auto";
  std::vector<std::string> models{};  // methods or model files; empty: those of `line_up`
  std::string line_up{};  // a name of line_ups() (model_worker.h); empty or unknown: the scene's default models
  // Additional models, of an earlier session (SessionModels::requests). `refits` false: the session has only these.
  std::vector<ModelRequest> kept{};
  bool refits = true;
  std::uint64_t seed = 1;      // of the training recording and the fits; the hand and the test have seed + 1
  bool realtime = true;        // asks for real-time scheduling
  bool known_device = false;   // no notice about the device
  std::string ready_models{};  // a folder (scenes/worker/model_worker.h); empty: every model is fitted
  std::string data_folder{};   // for fault files; empty: the working directory
  DeviceBus* bus = nullptr;    // outlives the session; null: the bus of this machine
};

// The devices that need no argument after their name, for code that may not include devices/. Blocks: opens and
// closes each connected device.
std::vector<DeviceDescription> device_choices();

class LiveSession {
 public:
  // Reads the scene, recordings and model files, opens the device and starts the loop; models are fitted in the
  // background. Errors: those of load_scene, read_usable_recording, requested_models and open_device; a thread cannot
  // be started.
  static Result<std::unique_ptr<LiveSession>> open(const SessionRequest& request);
  // Calls `close`, and waits for the fits that it interrupts.
  ~LiveSession();
  // Ends a recording and waits until it is on the disk; ramps the force to zero; closes the device; interrupts fits and
  // does not wait for them. Then only the destructor may be called.
  void close();

  // Call it once a frame: processes all ticks since the last call and the models that became ready.
  void update();

  const Scene& scene() const noexcept { return scene_; }
  const JndLine& jnd() const noexcept { return scene_.jnd; }
  const LoopSnapshot& newest() const noexcept { return newest_; }
  const HapticsLoop& loop() const noexcept { return *loop_; }

  // The next `update` hands changed models to the loop and clears the errors.
  SessionModels& models() noexcept { return models_; }
  const SessionModels& models() const noexcept { return models_; }
  // The line-up that is shown; empty: the default models of the scene, or models that were named one by one.
  const std::string& line_up() const noexcept { return request_.line_up; }
  void use_line_up(const std::string& name);  // ignored when unknown or without a material to fit to
  // The moment of the model's largest error (mean over 50 ms) in the test, with the ticks of all models around it; with
  // `of_test` false, or without a test, in the ticks of this session. `zero_s`: the loop time of the first tick of the
  // test. Takes some tenths of a second. Empty: the model is not ready, or nothing was compared yet.
  struct Worst {
    std::size_t slot = 0;
    std::string words{};                            // motion_words
    double at_s = 0.0;                              // loop time
    std::shared_ptr<const ForceHistory> history{};  // of the test; null: that of the session
  };
  std::optional<Worst> worst(std::size_t slot, bool of_test, double zero_s) const;

  // The reference, and the errors against it.
  const Comparison& comparison() const noexcept { return comparison_; }
  bool has_reference() const {
    return comparison_.reference() != ReferenceKind::model || models_.reference().has_value();
  }
  // Errors over the test recording; where there is none, those of the ticks so far.
  ModelFigures figures(std::size_t slot) const;
  // The test whose errors and times rank the models. Its surface offset is that of the replay.
  const ModelTest& test() const noexcept { return test_; }
  // The file of the test recording; empty: there is none, or it is that of the virtual material.
  std::string test_file() const;
  std::string test_name() const;  // in words
  Verdict verdict() const;
  // Whether models were fitted to the test recording.
  bool tests_training() const;
  // "true force of the virtual material, silicone"; `brief`: "the material".
  std::string reference_words(bool brief = false) const;
  // Clears the errors of the ticks so far and acknowledges the alarms; the history stays.
  void reset_figures();
  // Times since the session was opened; NaN: not yet.
  struct StartTimes {
    double first_model_s = kUnknown, all_models_s = kUnknown, verdict_s = kUnknown;
  };
  const StartTimes& start_times() const noexcept { return start_; }

  const FaultLog& faults() const noexcept { return faults_; }
  std::vector<std::string> alarms() const { return faults_.alarms(newest_); }  // see FaultLog::alarms

  // The device. Its state is `newest().device`.
  const std::string& device_name() const noexcept { return device_->name(); }
  std::string device_words() const;  // what the user has to do so that it renders force; may be empty
  bool renders_force() const noexcept { return device_->holder() == Holder::person; }
  void start_zeroing() { device_->start_zeroing(); }  // call it while the tool is at its rest position
  ToolInput* tool_input() const noexcept { return device_->tool_input(); }
  ReplayControl* replay() const noexcept { return device_->replay(); }
  void move_surface(bool moved);  // of the replay (ModelTest::move); clears the errors
  // The user's settings of the loop, which the next `update` hands to it: the force scale, the dead-man switch, and the
  // time when its key was last held. The session sets the other fields.
  LoopControls& controls() noexcept { return controls_; }
  const LoopControls& controls() const noexcept { return controls_; }

  // Records every sample from now on, with the selected reference as its force. A notice reports the outcome.
  // Errors: the file exists or cannot be written, a recording is running, there is no reference.
  Status start_recording(const std::string& path);
  void stop_recording() { recorder_->stop(); }
  RecordingStatus recording() const noexcept { return recorder_->status(); }

  // Returns and clears the notices since the last call.
  Notices read_notices() { return std::exchange(notices_, {}); }

 private:
  // `part`: the test, if it was set apart from `training`.
  LiveSession(const SessionRequest& request, Scene scene, std::unique_ptr<Device> device,
              std::vector<Recording> training, std::optional<Recording> part);
  ModelTest::MakeRecording make_test(std::optional<Recording> part) const;
  Status begin(const std::vector<ModelRequest>& plans);
  void update_models();
  void publish();
  void read_snapshots();
  void save_fault_ticks();
  void update_verdict();
  std::shared_ptr<const ForceHistory> worst_of_test(std::size_t slot, const Recording& recording, double zero_s) const;

  SessionRequest request_;
  Scene scene_;
  Notices notices_;
  // Members depend on those above them; destruction is in reverse order.
  std::unique_ptr<Device> device_;
  bool set_apart_ = false;                 // the test is a part of a training recording
  std::shared_ptr<ReferenceForce> truth_;  // null: none for this scene and device
  std::unique_ptr<HapticsLoop> loop_;
  SessionModels models_;
  Comparison comparison_;
  MotionHistory history_;
  ModelTest test_;
  FaultLog faults_;
  FaultRecorder fault_recorder_;
  std::unique_ptr<SessionRecorder> recorder_;
  LoopControls controls_;
  int fault_files_ = 0;
  double began_s_ = 0.0;  // steady clock
  StartTimes start_;
  Verdict verdict_;
  std::uint64_t judged_ = 0;  // ModelTest::results of the verdict
  double judged_s_ = 0.0;     // time of the verdict since the start
  std::map<std::size_t, CentresPath> paths_;
  LoopSnapshot newest_;
  std::vector<LoopSnapshot> buffer_;
};

}  // namespace palpate
