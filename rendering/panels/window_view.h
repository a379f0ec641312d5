// What the window shows in a frame, as plain data: made once a frame from the session, and then read by the
// blocks, the words over them, the panels and the exhibit alike, so that they tell one story. A panel's
// sentences are tested without a session, a thread or a device.
// Thread guarantee: values of the window's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/live/device_health.h"
#include "engine/live/haptics_loop.h"
#include "engine/tick/jnd.h"
#include "rendering/panels/view_state.h"
#include "scenes/live/comparison.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/force_history.h"
#include "scenes/live/session_models.h"
#include "scenes/live/verdict.h"

namespace palpate {

class LiveSession;

// In place of a slot: the block of what the models are compared with.
inline constexpr std::size_t kReferenceBlock = static_cast<std::size_t>(-1);

// A slot: its model and how it does.
struct ModelView : ModelInfo, ModelFigures {};

// The models in the order of their slots.
struct ModelsView {
  std::vector<ModelView> slots;
  std::size_t selected = 0;
  bool in_contact = false;
  bool compared = true;                     // there is a reference
  std::size_t reference = kReferenceBlock;  // the slot of it, where it is a model
  std::string off_from = "the material";    // what errors are off from, in few words
  std::string counted;                      // over which samples errors are, in words
  bool knows_this = false;                  // the recording that is replayed is one of the training
  JndLine jnd{};
  Verdict verdict;
  // The last tick that the curves show.
  HistoryPoint now;
  bool any_now = false;

  // The slots that are not hidden, in order: what keys and tables count.
  std::vector<std::size_t> listed() const;
  // 1 for the first of them.
  std::size_t number_of(std::size_t slot) const;
  // The active model; null: none is ready.
  const ModelView* active() const noexcept;
  // Whether the active model is used where nothing was recorded.
  bool out_of_domain() const noexcept;
};

struct HealthView {
  LoopStatistics loop;
  RtStatus scheduling;
  double missed_of_late = 0.0;  // share of deadlines, over some ten seconds
  double now_s = 0.0;           // loop time
  std::vector<FaultEvent> faults;
  std::vector<std::string> alarms;  // not yet seen by the user
  std::string device_name;
  DeviceHealth device;
  double heat_share = 0.0;                     // of the motor's thermal budget
  double stiffness_share = 1.0, lag_ms = 0.0;  // see LoopSnapshot
};

struct WindowView {
  std::uint64_t number = 0;  // of all that were made so far
  ModelsView models;
  HealthView health;
  // What the blocks show: slots, in order, the active one and the verdict's always among them; of several the
  // last is the reference's own (kReferenceBlock), where that is no model.
  std::vector<std::size_t> stage;
  std::string reference_block;  // its name
  std::string reference_words;
  double reference_N = std::numeric_limits<double>::quiet_NaN();
  double usual_force_N = 0.0;  // the axis holds it always, so that it does not jump
  double usual_depth_m = 0.0;
  const ForceHistory* history = nullptr;  // of the session; never null when made from one
};

WindowView window_view(const LiveSession& session, const ViewState& view);
HealthView health_view(const LiveSession& session);

// Over which samples errors are counted, since when, and what is left out, in words.
std::string counted_words(const LiveSession& session);

}  // namespace palpate
