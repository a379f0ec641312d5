// A live session: a scene, a device, the haptics loop and the models that are
// compared, with everything a window shows of them. No window, no drawing: the
// window asks and shows, tests run it without one.
//
// Models have slots, numbered in the order in which they were asked for; a slot
// keeps its number for the session. A slot's model is fitted or read by a
// worker thread, the quickest first, and joins the loop when it is ready, so
// that a session is alive at once.
//
// Thread guarantee: one thread (the window's) for everything here; it never
// waits for the haptics thread, nor that for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/live/haptics_loop.h"
#include "engine/tick/jnd.h"
#include "engine/base/result.h"
#include "scenes/live/error_figures.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/force_history.h"
#include "scenes/live/session_recorder.h"
#include "scenes/scene/scene.h"

namespace palpate {

class AutoDevice;
class HidBus;
class ModelWorker;
class MouseDevice;
class ReplayDevice;
struct FinishedModel;

struct SessionRequest {
  std::string scene = "silicone_block";
  std::string device = "auto";
  std::vector<std::string> models;  // methods or model files; empty: the scene's default
  std::uint64_t seed = 1;           // of the hand, the training recording, the fits
  bool position_only = false;  // one more slot: a model that knows the depth alone
  bool realtime = true;
  HidBus* bus = nullptr;  // outlives the session; null: the machine's own
};

// What the models are compared with.
enum class ReferenceKind : std::uint8_t {
  measured,  // the force in the recording that is replayed
  truth,     // of the scene's virtual material under the same tool
  direct,    // the direct interpolant, all sites
};
inline constexpr std::array<ReferenceKind, 3> kReferenceKinds{ReferenceKind::measured, ReferenceKind::truth,
                                                              ReferenceKind::direct};

enum class SlotState : std::uint8_t { waiting, fitting, ready, failed };

// One model as the window shows it.
struct SlotView {
  std::string name;    // distinct among the slots
  std::string method;  // direct, voxel, random, kdtree, greedy; "position" for depth alone
  int centres = 0;     // nodes for a grid; 0 until ready
  SlotState state = SlotState::waiting;
  double progress = 0.0;  // of the fit, 0..1
  std::string problem;    // when failed
  // In the newest tick; 0 until ready.
  double force_N = 0.0;
  double error_N = 0.0;  // signed, model - reference; 0 out of contact or without reference
  double error_over_jnd = 0.0;
  bool out_of_domain = false;
  double evaluation_ns = 0.0;  // median over about the last second in contact
  // Since the last reset, over samples in contact.
  ErrorFigures errors;
  // For drawing. Depth of the dent: the tool's while it presses, behind it the
  // surface's slow return, which follows the model's own relaxation times.
  double dent_m = 0.0;
  // Error/JND to colour the dent with: the largest of late, fading in 0.3 s.
  double dent_error_over_jnd = 0.0;
};

struct ReplayStatus {
  bool present = false;  // the device is a recording
  bool paused = false;
  double speed = 1.0;
  double at_s = 0.0;
  double duration_s = 0.0;
};

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

  // Once a frame: takes in all ticks since the last call and what the worker has
  // ready.
  void update();

  const Scene& scene() const noexcept { return scene_; }
  const JndLine& jnd() const noexcept { return scene_.jnd; }
  const std::string& device_name() const noexcept;

  // Models.
  std::size_t slot_count() const noexcept { return slots_.size(); }
  const SlotView& slot(std::size_t index) const noexcept;
  // The slot in the hand, as asked for; the force fades to it.
  std::size_t selected() const noexcept { return selected_; }
  void select(std::size_t slot);  // ignored unless ready
  bool fading() const noexcept { return newest_.fading; }
  // Reads a model file in the background into a new slot. Trouble becomes a
  // notice, and no slot.
  void load_file(const std::string& path);
  // Whether all that was asked for is ready or has failed.
  bool all_settled() const noexcept;

  // Reference.
  bool has_reference(ReferenceKind kind) const noexcept;
  ReferenceKind reference() const noexcept { return reference_; }
  void use_reference(ReferenceKind kind);  // resets the figures; ignored without one
  // "true force of the virtual silicone", "force in the recording", ...
  std::string reference_words() const;
  double reference_N() const noexcept { return reference_N_; }  // in the newest tick; NaN: none
  // Forgets errors so far and alarms that are over; curves stay.
  void reset_figures();

  // Ticks.
  const LoopSnapshot& newest() const noexcept { return newest_; }
  const ForceHistory& history() const noexcept { return history_; }
  LoopStatistics statistics() const noexcept;
  const RtStatus& scheduling() const noexcept;
  const std::vector<FaultEvent>& faults() const noexcept { return faults_.events(); }  // the last 200
  double missed_of_late() const noexcept { return faults_.missed_of_late(); }
  // What went wrong since the last reset_figures, in words, the worst first.
  std::vector<std::string> alarms() const { return faults_.alarms(newest_); }

  // The device: `newest().device` says how it is. Whether it renders force at all;
  // what to do for it to, empty when nothing; the tool is at its rest position.
  bool device_pushes() const noexcept;
  std::string device_words() const;
  void start_zeroing();
  // What must be held for the device to push; `hold` says that it is, every frame.
  DeadMan dead_man() const noexcept { return dead_man_; }
  void use_dead_man(DeadMan what);
  void hold();

  // The tool by mouse and keys; no effect on a device that takes neither.
  bool takes_mouse() const noexcept;
  void set_tool_target(double position_m);
  void nudge_tool(double by_m);
  bool hand_is_exploring() const noexcept;  // nobody has taken over

  // A recording as device; no effect otherwise.
  ReplayStatus replay() const noexcept;
  void pause_replay(bool paused);
  void set_replay_speed(double speed);
  void seek_replay(double at_s);

  // Records every sample from now on, with the reference that is selected as
  // its force. Errors: the file exists, cannot be written, already recording,
  // no reference.
  Status start_recording(const std::string& path);
  // The file appears whole under its name, or not at all; a notice says so.
  void stop_recording();
  RecordingStatus recording() const noexcept;

  // What happened since the last call, oldest first.
  std::vector<Notice> take_notices();

 private:
  struct Slot;
  // Which slots' models a set in the loop holds, so that its snapshots are read
  // rightly also after the next one was published.
  struct PublishedSet {
    std::uint32_t id = 0;
    std::vector<std::size_t> slots;
  };

  LiveSession(const SessionRequest& request, Scene scene, std::unique_ptr<Device> device);
  Status begin();
  void take_models();
  void take_file(FinishedModel& finished);
  void join(std::size_t index, FinishedModel& finished);
  void publish();
  void send_controls();
  void take_snapshots();
  void take(const LoopSnapshot& snapshot);
  void take_slot(std::size_t index, std::size_t slot, const LoopSnapshot& snapshot, double reference_N);
  void show_newest();
  void see_faults();
  void save_fault_ticks();
  const PublishedSet* set_of(const LoopSnapshot& snapshot) const noexcept;
  double reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept;
  MouseDevice* mouse() const noexcept;
  void reset_errors();
  void say(std::string text, bool problem);
  std::string distinct_name(const std::string& name, const Slot* but) const;
  std::vector<std::string> recording_comments() const;

  SessionRequest request_;
  Scene scene_;
  // In the order in which they need each other; gone in the opposite order.
  std::unique_ptr<Device> device_;
  AutoDevice* auto_ = nullptr;      // device_, when it is one
  MouseDevice* mouse_ = nullptr;    // likewise
  ReplayDevice* replay_ = nullptr;  // likewise
  std::shared_ptr<ReferenceForce> truth_;  // null: none for this scene and device
  std::unique_ptr<HapticsLoop> loop_;
  std::unique_ptr<ModelWorker> worker_;
  std::unique_ptr<SessionRecorder> recorder_;
  std::uint32_t recording_ = 0;  // these four as in LoopControls
  std::uint32_t acknowledged_ = 0;
  DeadMan dead_man_ = DeadMan::off;
  double held_s_ = -std::numeric_limits<double>::infinity();
  int fault_files_ = 0;

  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<PublishedSet> sets_;  // newest last
  std::optional<std::size_t> direct_slot_;
  std::size_t selected_ = 0;
  bool user_chose_ = false;
  std::size_t outstanding_ = 0;        // orders of which nothing was heard
  std::size_t outstanding_files_ = 0;  // of these, files without a slot

  ReferenceKind reference_ = ReferenceKind::direct;
  double reference_N_ = kNoForce;
  LoopSnapshot newest_;
  std::vector<LoopSnapshot> buffer_;
  bool begun_in_air_ = false;  // since the filters started
  double last_loop_time_s_ = 0.0;
  ForceHistory history_;
  FaultLog faults_;
  std::vector<Notice> notices_;
};

}  // namespace palpate
