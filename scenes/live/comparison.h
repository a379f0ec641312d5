// Compares the models of a session with a reference force. It has, for every slot, the errors in total and by stroke,
// the sustained error and the dent that is drawn.
// A sample counts if it is in contact and valid, the reference is known, no compared model is outside its training
// domain, and the feature filters have settled: a sample of the stream was out of contact, the stream began with the
// recording, or it has run for 5 times the longest relaxation time of the models.
// Thread guarantee: one thread.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "engine/live/live_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/live/dent.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/force_history.h"
#include "scenes/live/session_models.h"
#include "scenes/live/stream_errors.h"

namespace palpate {

// The state and the errors of one slot's model, for display.
struct ModelFigures {
  // The values of the newest tick; 0 until the model is ready.
  double force_N = 0.0;
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();  // of the force, 95 %; NaN: unknown
  bool out_of_domain = false;
  // Over the same samples for all compared models. The 99 % error has a resolution of 1.1 % (stream_errors.h).
  ErrorSummary errors;
  // For drawing (dent.h): depth of the dent, and the largest recent magnitude of the sustained error.
  double dent_m = 0.0;
  double recent_error_over_jnd = 0.0;
};

class Comparison {
 public:
  // `models` outlive this.
  Comparison(const SessionModels& models, const JndLine& jnd);

  ReferenceKind reference() const noexcept { return reference_; }
  void use_reference(ReferenceKind kind);                       // clears the errors when `kind` is another one
  double reference_N() const noexcept { return reference_N_; }  // in the newest tick; NaN: none
  const ForceHistory& history() const noexcept { return history_; }

  // `time_s`: device time of the first sample of the replayed recording. Filters that start there have settled.
  void begins_at(double time_s) noexcept { begins_at_s_ = time_s; }
  void begin_slot(std::size_t slot);   // its model became ready
  void forget_slot(std::size_t slot);  // its model was removed
  // Call it for every snapshot in order, with the return value of FaultLog::update.
  void add(const LoopSnapshot& snapshot, TickFaultLevel fault_level);
  // Call it once a frame, after `add`: sets the figures of the newest tick and updates the errors by stroke.
  void show(const LoopSnapshot& newest);
  // Clears the errors, but not the history. `why`: the reason in words, e.g. "voxel joined".
  void forget_errors(std::string why);
  // The reason of the last clearing, "the start" before the first.
  const std::string& counted_since() const noexcept { return since_; }
  // Since the last clearing: duration of contact with a reference, and the part of it that counts.
  double contact_s() const noexcept { return contact_s_; }
  double counted_s() const noexcept { return counted_s_; }
  // The part of the contact in which any model was outside its training domain; the slot that was outside longest.
  double outside_s() const noexcept { return outside_s_; }
  std::size_t mostly_outside() const noexcept;

  ModelFigures figures(std::size_t slot) const;
  // The errors by stroke, for a ranking. They are updated every 2 s, because there may be hundreds of strokes and the
  // ranking shall not flicker. Before kLeastContact_s of counted contact they have no samples.
  const UnitErrors& unit_errors(std::size_t slot) const noexcept { return slots_[slot].unit_errors; }

  // The duration of counted contact that a ranking needs.
  static constexpr double kLeastContact_s = 1.0;

 private:
  struct Slot {
    ModelFigures newest;  // without errors
    Dent dent;
    SustainedError sustained;
    double sustained_over_jnd = 0.0;  // in the last snapshot; ticks without a reference count as 0
    StreamErrors errors;
    UnitErrors unit_errors;
    double outside_s = 0.0;
  };
  HistoryPoint point_of(const LoopSnapshot& snapshot, const PublishedSet* set);
  void count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set, double step_s);
  void count_errors(const HistoryPoint& point, const PublishedSet& set);
  double reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept;

  const SessionModels& models_;
  JndLine jnd_;
  ReferenceKind reference_ = ReferenceKind::direct;
  double reference_N_ = kNoForce;
  std::vector<Slot> slots_{kMaxModels};
  std::string since_ = "the start";
  double contact_s_ = 0.0, counted_s_ = 0.0, outside_s_ = 0.0;
  double unit_errors_s_ = 0.0;  // loop time of the next update of the errors by stroke
  StrokeCounter strokes_;
  bool stroke_pending_ = true;   // a stroke has begun since the last sample that counts
  bool settled_ = false;         // the feature filters have settled
  double stream_began_s_ = 0.0;  // device time
  double begins_at_s_ = -std::numeric_limits<double>::infinity();
  double last_loop_time_s_ = 0.0;
  double last_time_s_ = 0.0;                           // device time
  TickFaultLevel fault_level_ = TickFaultLevel::none;  // the worst since the last point of the history
  ForceHistory history_;
};

}  // namespace palpate
