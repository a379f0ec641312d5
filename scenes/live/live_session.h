// A live session without a window: a scene, a device, the haptics loop, the models (SessionModels), how they
// agree with a reference (Comparison; over a whole recording ReplayTest), the verdict, the recorder and the
// log of faults.
// Thread guarantee: one thread (the window's); it never waits for the haptics thread, nor that for it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/live/fault_recorder.h"
#include "engine/live/haptics_loop.h"
#include "engine/tick/jnd.h"
#include "engine/tick/motion_history.h"
#include "scenes/live/comparison.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/notices.h"
#include "scenes/live/replay_test.h"
#include "scenes/live/session_models.h"
#include "scenes/live/session_recorder.h"
#include "scenes/live/verdict.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/slot_plan.h"

namespace palpate {

class DeviceBus;
struct Recording;

struct SessionRequest {
  std::string scene;  // empty: silicone, or of model files alone what they were fitted for
  // The material that models are fitted to, all of them one training set; none: the recording that the device
  // replays, or the scene's virtual material.
  std::vector<std::string> recordings;
  std::string device = "auto";
  std::vector<std::string> models;  // methods or model files; empty: the line-up
  std::string line_up;              // of line_ups(); empty, or not of the scene's: the scene's default
  // Models of a session before (SessionModels::plans): they stay. `refits` false: there are no others.
  std::vector<SlotPlan> kept;
  bool refits = true;
  std::uint64_t seed = 1;      // of the hand, the training recording, the fits
  bool position_only = false;  // one more slot: a model that knows the depth alone
  bool realtime = true;
  std::string data_folder;   // for files about faults; empty: where the program runs
  DeviceBus* bus = nullptr;  // outlives the session; null: the machine's own
};

// What a hand must stay inside of, for models to know its presses: of what is in contact in all of these.
struct PressRange {
  double strongest_N = 0.0;
  double deepest_m = 0.0;
  double fastest_m_per_s = 0.0;
};
PressRange press_range(const std::vector<Recording>& recordings);

// The devices that a session can be opened with, for whoever does not see them.
struct DeviceChoice {
  std::string name;
  std::string summary;  // one line
  std::string problem;  // why it cannot be opened and what to do; empty: it can
};

// Those that need no more than their name. Slow: opens and closes what is plugged in.
std::vector<DeviceChoice> device_choices();

class LiveSession {
 public:
  // Quick: fits and files come later. Errors: unknown scene, unknown method, a
  // model file that does not exist, the device cannot be opened, more than
  // kMaxModels models, no thread.
  static Result<std::unique_ptr<LiveSession>> open(const SessionRequest& request);
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  // Ends a recording as stop_recording does, and waits until it is on the disk;
  // lets the force go to zero; interrupts fits.
  ~LiveSession();

  // Once a frame: takes in all ticks since the last call and what the worker has ready.
  void update();

  const Scene& scene() const noexcept { return scene_; }
  const JndLine& jnd() const noexcept { return scene_.jnd; }
  const LoopSnapshot& newest() const noexcept { return newest_; }
  const HapticsLoop& loop() const noexcept { return *loop_; }  // its statistics and scheduling

  // Models.
  const SessionModels& models() const noexcept { return models_; }
  void select(std::size_t slot);  // makes its model the active one; ignored unless ready
  bool load_file(const std::string& path) { return models_.load_file(path); }
  Status save_model(std::size_t slot, const std::string& path) const { return models_.save(slot, path); }
  void claim(std::size_t slot);  // see SessionModels
  void rename(std::size_t slot, const std::string& name) { models_.rename(slot, name); }
  void refit(std::size_t slot, int centres) { models_.refit(slot, centres); }
  void remove(std::size_t slot);  // ignored, with a notice: it is the last one
  // The line-up that is shown; empty: models that were asked for one by one.
  const std::string& line_up() const noexcept { return request_.line_up; }
  void use_line_up(const std::string& name);

  // What they are compared with, and how that went.
  const Comparison& comparison() const noexcept { return comparison_; }
  // Its errors are those over the whole recording, where one is replayed and the models are compared with it.
  ModelFigures figures(std::size_t slot) const;
  // Whether they are: the same wherever the playhead is.
  bool tests_recording() const noexcept;
  // By what is judged of the models now.
  Verdict verdict() const;
  // Whether the recording that is replayed is among those that the models are fitted to.
  bool replays_training() const noexcept;
  bool has_reference(ReferenceKind kind) const noexcept;
  void use_reference(ReferenceKind kind);  // forgets the errors; ignored without one
  // "true force of the virtual silicone"; `brief`: what errors are off from, in few words.
  std::string reference_words(bool brief = false) const;
  // Forgets errors so far and alarms that are over; curves stay.
  void reset_figures();

  // What went wrong; `alarms`: since the last reset_figures, in words, the worst first.
  const FaultLog& faults() const noexcept { return faults_; }
  std::vector<std::string> alarms() const { return faults_.alarms(newest_); }

  // The device: `newest().device` says how it is.
  const std::string& device_name() const noexcept { return device_->name(); }
  std::string device_words() const;                   // what to do for it to render force; empty: nothing
  bool renders_force() const noexcept;                // that a person feels
  void start_zeroing() { device_->start_zeroing(); }  // the tool is at its rest position
  // What it can be asked for beside: null when it cannot.
  ToolInput* tool_input() const noexcept { return device_->tool_input(); }
  ReplayControl* replay() const noexcept { return device_->replay(); }
  // Where the surface of a recording is for the models. Errors so far are forgotten with every change.
  const ReplayTest& replay_test() const noexcept { return test_; }
  void move_surface(bool moved);
  // What must be held for the device to push; `hold` says that it is, every frame.
  DeadMan dead_man() const noexcept { return controls_.dead_man; }
  void use_dead_man(DeadMan what);
  void hold();
  // Of the active model's force in the hand; errors stay those of the models as they are.
  const ForceScale& scale() const noexcept { return controls_.scale; }
  void use_scale(const ForceScale& scale);

  // Records every sample from now on, with the selected reference as its force; a notice says how it ended.
  // Errors: the file exists, cannot be written, already recording, no reference.
  Status start_recording(const std::string& path);
  void stop_recording();
  RecordingStatus recording() const noexcept { return recorder_->status(); }

  // What happened since the last call.
  Notices read_notices() { return std::exchange(notices_, {}); }

 private:
  LiveSession(const SessionRequest& request, Scene scene, std::unique_ptr<Device> device);
  Status begin(const std::vector<SlotPlan>& plans);
  void update_models();
  void publish(std::string why);
  void read_snapshots();
  void check_faults();
  void save_fault_ticks();
  std::string why_no_verdict() const;
  void send_controls();
  std::vector<std::string> recording_comments() const;

  SessionRequest request_;
  Scene scene_;
  Notices notices_;
  // In the order in which they need each other; gone in the opposite order.
  std::unique_ptr<Device> device_;
  std::shared_ptr<ReferenceForce> truth_;  // null: none for this scene and device
  std::unique_ptr<HapticsLoop> loop_;
  SessionModels models_;
  Comparison comparison_;
  MotionHistory history_;
  ReplayTest test_;
  LiveJudge judge_;
  FaultLog faults_;
  FaultRecorder fault_recorder_;
  std::unique_ptr<SessionRecorder> recorder_;
  LoopControls controls_;
  int fault_files_ = 0;
  LoopSnapshot newest_;
  std::vector<LoopSnapshot> buffer_;
};

}  // namespace palpate
