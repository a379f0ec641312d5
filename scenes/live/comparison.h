// Compares the models of a session with a reference force, tick by tick. It has, for every slot, the errors of these
// ticks, the sustained error and the dent that is drawn.
// A sample counts if it is in contact and valid, the reference is known, no compared model is outside its training
// domain, and the feature filters have settled: a sample of the stream was out of contact, the stream began with the
// recording, or it has run for 5 times the longest relaxation time of the models.
// Thread guarantee: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "engine/live/live_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/live/dent.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/force_history.h"
#include "scenes/live/session_models.h"
#include "scenes/live/stream_errors.h"

namespace palpate {

// Time of a tick, ns, and 99 % error over the JND of a model with each number of centres that was tested.
using CentresPath = std::map<int, std::pair<double, double>>;

// The state and the errors of one slot's model, for display.
struct ModelFigures {
  // The values of the newest tick; 0 until the model is ready.
  double force_N = 0.0;
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();  // of the force, 95 %; NaN: unknown
  bool out_of_domain = false;
  // Over the same samples for all compared models: those of the test (model_test.h); without a recording to test on,
  // those of the ticks, whose 99 % error has a resolution of 1.1 % (stream_errors.h).
  ErrorSummary errors;
  Interval p99_interval{kUnknown, kUnknown};  // of the test
  Timing tick;                                // a whole tick with this model alone
  CentresPath path;
  double tick_ns() const noexcept { return tick.median_ns; }
  // Of the ticks, the user's own presses.
  std::uint64_t press_samples = 0;
  double press_p99_over_jnd = 0.0;
  // For drawing (dent.h): depth of the dent, and the largest recent magnitude of the sustained error.
  double dent_m = 0.0, recent_error_over_jnd = 0.0;
};

class Comparison {
 public:
  // `models` outlive this.
  Comparison(const SessionModels& models, ReferenceKind reference, const JndLine& jnd);

  ReferenceKind reference() const noexcept { return reference_; }
  double reference_in(const LoopSnapshot& snapshot) const noexcept;  // NaN: none
  const ForceHistory& history() const noexcept { return history_; }

  // `time_s`: device time of the first sample of the replayed recording. Filters that start there have settled.
  void begins_at(double time_s) noexcept { begins_at_s_ = time_s; }
  void begin_slot(std::size_t slot);   // its model became ready
  void forget_slot(std::size_t slot);  // its model was removed
  // Call it for every snapshot in order, with the return value of FaultLog::update.
  void add(const LoopSnapshot& snapshot, TickFaultLevel fault_level);
  // Clears the errors, but not the history.
  void forget_errors();
  // The duration of contact that counts, since the last clearing.
  double counted_s() const noexcept { return counted_s_; }

  // Without those of the newest tick and of the test.
  ModelFigures figures(std::size_t slot) const;

 private:
  struct Slot {
    Dent dent;
    SustainedError sustained;
    double sustained_over_jnd = 0.0;  // in the last snapshot; ticks without a reference count as 0
    StreamErrors errors;
  };
  HistoryPoint point_of(const LoopSnapshot& snapshot, const PublishedSet* set);
  void count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set, double step_s);

  const SessionModels& models_;
  JndLine jnd_;
  ReferenceKind reference_;
  std::vector<Slot> slots_{kMaxModels};
  double counted_s_ = 0.0;
  bool settled_ = false;         // the feature filters have settled
  double stream_began_s_ = 0.0;  // device time
  double begins_at_s_ = -std::numeric_limits<double>::infinity();
  double last_loop_time_s_ = 0.0;
  double last_time_s_ = 0.0;                           // device time
  TickFaultLevel fault_level_ = TickFaultLevel::none;  // the worst since the last point of the history
  ForceHistory history_;
};

}  // namespace palpate
