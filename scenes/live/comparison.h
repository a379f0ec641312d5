// How well the models of a session agree with their reference: the one owner of every slot's errors, their
// quantiles, the sustained error, and the dent that a picture shows.
// A sample counts when it is in contact, models and reference are there, none of them is outside of its data,
// and the filters know what was before: they have seen a sample out of contact, or the beginning of the
// recording, or have run for several times their longest memory.
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
#include "scenes/evaluation/model_errors.h"
#include "scenes/live/dent.h"
#include "scenes/live/error_quantile.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/force_history.h"
#include "scenes/live/session_models.h"
#include "scenes/live/sustained_error.h"

namespace palpate {

// What is known of a slot's model, for the window.
struct ModelFigures {
  // In the newest tick; 0 until ready.
  double force_N = 0.0;
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();  // of the force, 95 %; NaN: unknown
  bool out_of_domain = false;
  // Over the same samples for all models that are compared; the 99 % error within 4.4 % (error_quantile.h).
  ErrorSummary errors;
  // For drawing (dent.h): the dent's depth, and the largest recent sustained error.
  double dent_m = 0.0;
  double recent_error_over_jnd = 0.0;
};

class Comparison {
 public:
  // `models` outlive this.
  Comparison(const SessionModels& models, const JndLine& jnd);

  ReferenceKind reference() const noexcept { return reference_; }
  void use_reference(ReferenceKind kind);                       // forgets the errors
  double reference_N() const noexcept { return reference_N_; }  // in the newest tick; NaN: none
  // One point a tick of the last minutes.
  const ForceHistory& history() const noexcept { return history_; }

  // Device time at which a recording begins: a replay from there has seen all of it.
  void begins_at(double time_s) noexcept { begins_at_s_ = time_s; }
  void begin_slot(std::size_t slot);   // its model became ready
  void forget_slot(std::size_t slot);  // its model is gone
  // Every snapshot in order, with what the fault log says of it.
  void add(const LoopSnapshot& snapshot, TickTrouble trouble);
  // After them, once a frame: what the figures say of the newest one.
  void show(const LoopSnapshot& newest);
  // Forgets the errors so far, and why, in words: "voxel joined"; curves stay.
  void forget_errors(std::string why);
  // Since when the figures count: "the start", "voxel joined".
  const std::string& counted_since() const noexcept { return since_; }
  // Of the contact since then: how long it lasted, and how much of it counts.
  double contact_s() const noexcept { return contact_s_; }
  double counted_s() const noexcept { return counted_s_; }
  // How much of it was outside the data of some model, and of which one mostly.
  double outside_s() const noexcept { return outside_s_; }
  std::size_t mostly_outside() const noexcept;

  ModelFigures figures(std::size_t slot) const;
  // The errors so far with their strokes, for a ranking: of the first kMostJudged samples.
  const ModelErrors& evidence(std::size_t slot) const noexcept { return slots_[slot].evidence; }

  // Ten minutes of contact at 1 kHz, 2.4 MB a model.
  static constexpr std::uint64_t kMostJudged = 600'000;

 private:
  struct Slot {
    ModelFigures newest;  // without errors
    Dent dent;
    SustainedError sustained;
    double sustained_over_jnd = 0.0;  // in the last snapshot; 0 without a comparison
    ErrorFigures errors;
    ErrorQuantile quantile;
    ModelErrors evidence{JndLine{}};
    double outside_s = 0.0;
  };
  // Everything that is said of a tick is made from its point.
  HistoryPoint point_of(const LoopSnapshot& snapshot, const PublishedSet* set);
  void count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set, double step_s);
  void count_errors(const HistoryPoint& point, const PublishedSet& set);
  double reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept;

  const SessionModels& models_;
  JndLine jnd_;
  ReferenceKind reference_ = ReferenceKind::direct;
  double reference_N_ = kNoForce;
  std::vector<Slot> slots_;
  std::string since_ = "the start";
  double contact_s_ = 0.0, counted_s_ = 0.0, outside_s_ = 0.0;
  std::uint64_t counted_ = 0;
  StrokeCounter strokes_;
  bool stroke_pending_ = true;   // one has begun since the last sample that counts
  bool settled_ = false;         // the filters know what was before
  double stream_began_s_ = 0.0;  // device time
  double begins_at_s_ = -std::numeric_limits<double>::infinity();
  double last_loop_time_s_ = 0.0;
  double last_time_s_ = 0.0;                 // device time
  TickTrouble trouble_ = TickTrouble::none;  // since the last sample
  ForceHistory history_;
};

}  // namespace palpate
