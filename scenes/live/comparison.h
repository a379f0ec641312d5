// How well the models of a session agree with their reference: errors, curves and dents, from one kind of
// sample: a tick that took one, in contact, of models and reference that are there.
// Errors count only after the filters have seen one sample out of contact: filters
// that begin in the middle of a press have not the state of its beginning.
// Thread guarantee: one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/live/live_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/live/dent.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/felt_error.h"
#include "scenes/live/force_history.h"
#include "scenes/live/model_slots.h"

namespace palpate {

class Comparison {
 public:
  // `slots` outlive this; their views get the figures.
  Comparison(ModelSlots& slots, const JndLine& jnd) : slots_(slots), jnd_(jnd) {}

  ReferenceKind reference() const noexcept { return reference_; }
  void use_reference(ReferenceKind kind);                       // forgets the errors
  double reference_N() const noexcept { return reference_N_; }  // in the newest tick; NaN: none
  // One point a tick of the last minutes.
  const ForceHistory& history() const noexcept { return history_; }

  // Device time at which a recording begins: who replays from there has seen all of it.
  void begins_at(double time_s) noexcept { begins_at_s_ = time_s; }
  void begin_slot(std::size_t slot);  // its model became ready
  // Every snapshot in order, with what the fault log says of it.
  void add(const LoopSnapshot& snapshot, TickTrouble trouble);
  // After them, once a frame: what the views say of the newest one.
  void show(const LoopSnapshot& newest);
  // Forgets the errors so far, and why, in words: "voxel joined"; curves stay.
  void forget_errors(std::string why);
  // Since when the figures count: "the start", "voxel joined".
  const std::string& counted_since() const noexcept { return since_; }

 private:
  struct Figures {
    Dent dent;
    FeltError felt;
    double felt_over_jnd = 0.0;  // in the last snapshot; 0 without a comparison
  };
  // Everything that is said of a tick is made from its point.
  HistoryPoint point_of(const LoopSnapshot& snapshot, const PublishedSet* set) const;
  void count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set);
  double reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept;
  void fit_slots();

  ModelSlots& slots_;
  JndLine jnd_;
  ReferenceKind reference_ = ReferenceKind::direct;
  double reference_N_ = kNoForce;
  std::vector<Figures> figures_;  // by slot
  std::string since_ = "the start";
  bool seen_out_of_contact_ = false;  // since the filters started
  double begins_at_s_ = -std::numeric_limits<double>::infinity();
  double last_loop_time_s_ = 0.0;
  TickTrouble trouble_ = TickTrouble::none;  // since the last sample
  ForceHistory history_;
};

}  // namespace palpate
