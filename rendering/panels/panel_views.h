// What each panel draws, as plain data, so that a panel's sentences are tested
// without a session, a thread or a device. The functions below fill the views from
// a session, once a frame.
// Thread guarantee: values of the window's thread.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "engine/live/device_health.h"
#include "engine/live/haptics_loop.h"
#include "engine/tick/jnd.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/force_history.h"
#include "scenes/live/model_slots.h"

namespace palpate {

class LiveSession;

// In place of a slot: the block of what the models are compared with.
inline constexpr std::size_t kReferenceBlock = static_cast<std::size_t>(-1);

// The models in the order of their slots; the pointers live as long as the session.
struct ModelsView {
  std::vector<const SlotView*> slots;
  std::size_t selected = 0;
  bool in_contact = false;
  bool compared = true;                     // there is a reference
  std::size_t reference = kReferenceBlock;  // the slot of it, where it is a model
  std::string off_from = "the material";    // what errors are off from, in few words
  std::string since = "the start";          // they count
  JndLine jnd{};
  const HistoryPoint* now = nullptr;  // the last tick that the curves show; null: none

  // The slots that are not hidden, in order: what keys and tables count.
  std::vector<std::size_t> listed() const;
  // 1 for the first of them.
  std::size_t number_of(std::size_t slot) const;
  // The active model; null: none is ready.
  const SlotView* active() const noexcept;
  // Whether the active model is used where nothing was recorded.
  bool out_of_domain() const noexcept;
};

struct ForceView {
  ModelsView models;
  const ForceHistory* history = nullptr;  // never null when filled from a session
  std::string reference_words;
  double usual_force_N = 0.0;  // the axis holds it always, so that it does not jump
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
  double heat_share = 0.0;                      // of the motor's thermal budget
  double stiffness_share = 1.0, late_ms = 0.0;  // see LoopSnapshot
};

// `until_s`: loop time at which the curves stand still.
ModelsView models_view(const LiveSession& session, double until_s = std::numeric_limits<double>::infinity());
ForceView force_view(const LiveSession& session, double until_s);
HealthView health_view(const LiveSession& session);

}  // namespace palpate
