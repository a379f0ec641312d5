// The contents of a frame as plain data. They are read from the session once a frame, so that blocks, overlay, panels
// and exhibit are consistent, and the texts can be tested without a session.
// Thread guarantee: values of the window's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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

// Instead of a slot: the block of a reference that is no model.
inline constexpr std::size_t kReferenceBlock = static_cast<std::size_t>(-1);

// A slot: its model and its errors.
struct ModelView : ModelInfo, ModelFigures {};

struct ModelsView {
  std::vector<ModelView> slots;
  std::size_t selected = 0;
  bool in_contact = false;
  bool compared = true;                         // there is a reference
  std::size_t reference = kReferenceBlock;      // its slot, if it is a model
  std::string reference_name = "the material";  // the reference in few words
  std::string counted;                          // the samples that the errors cover, in words
  bool replays_training = false;                // the replayed recording belongs to the training set
  JndLine jnd{};
  Verdict verdict;
  HistoryPoint now;  // the last tick that the curves show; without one all forces are NaN

  // The slots that are not hidden, in order. Keys and tables number them.
  std::vector<std::size_t> listed() const;
  // The slots that are ready, the active one last: it is drawn on top.
  std::vector<std::size_t> drawn() const;
  // The number of a listed slot, from 1.
  std::size_t number_of(std::size_t slot) const;
  // The active model; null unless it is ready.
  const ModelView* active() const noexcept;
  // Whether the active model is in contact outside its training domain, except in a replay of training data.
  bool out_of_domain() const noexcept;
};

struct HealthView {
  LoopStatistics loop;
  RtStatus scheduling;
  LoopSnapshot newest;
  double missed_of_late = 0.0;  // see FaultLog
  std::vector<FaultEvent> faults;
  std::vector<std::string> alarms;  // not acknowledged yet
  std::string device_name;
};

struct WindowView {
  std::uint64_t number = 0;  // of the views that were made, from 1
  ModelsView models;
  HealthView health;
  // The slots that have a block, in ascending order. If there is too little room, the active model and that of the
  // verdict come first. With several blocks the last one is kReferenceBlock if the reference is no model.
  std::vector<std::size_t> blocks;
  std::string reference_block;  // name of the block of the reference
  std::string reference_words;
  double now_s = 0.0;          // loop time at the right edge of running curves: now; of a paused replay its last tick
  double usual_force_N = 0.0;  // the axes extend at least to this force and this depth
  double usual_depth_m = 0.0;
  const ForceHistory* history = nullptr;  // of the session; not null in a result of window_view
};

WindowView window_view(const LiveSession& session, const ViewState& view);

// A warning that the active model is outside its training domain; else empty.
std::string data_warning(const ModelsView& models);

// The big number and its description: the 99 % error of the model in the headline, which is that of the table, and the
// error of the active model in the user's own presses. Without a reference it is the predicted error of the active
// model.
struct BigNumber {
  std::string number{};  // empty: there is none
  std::string what{}, below{};
  double error_over_jnd = 0.0;  // above 1 it is drawn in kAboveJndColour
};
BigNumber big_number(const ModelsView& models);

}  // namespace palpate
