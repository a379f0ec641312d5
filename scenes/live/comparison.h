// Compares the models of a session with a reference force, tick by tick. It has, for every slot, the errors of these
// ticks, the sustained error, the dent that is drawn, and the forces of the last kHistory_s at 1 kHz for curves: one
// point per tick that read a sample. Thread guarantee: one thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "engine/live/live_tick.h"
#include "engine/tick/features.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/live/fault_log.h"
#include "scenes/live/session_models.h"
#include "scenes/material/material.h"

namespace palpate {

inline constexpr double kHistory_s = 60.0;

// The force that the models are compared with.
enum class ReferenceKind : std::uint8_t {
  measured,  // of the device's force sensor, or of the recording that is replayed
  truth,     // of the scene's virtual material under the same tool
  model,     // of the model SessionModels::reference: there is no true force
};

inline constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, kMaxModels> no_values() noexcept {
  std::array<float, kMaxModels> values{};
  values.fill(kMissing);
  return values;
}

// Values are NaN where there is none.
struct HistoryPoint {
  double loop_time_s = 0.0;  // steady clock
  double time_s = 0.0;       // device time; the time in the recording where one is replayed
  float position_m = 0.0F;   // of the tool; negative in the air
  float depth_m = 0.0F;
  float reference_N = kMissing;
  float rendered_N = 0.0F;
  float predicted_error_N = kMissing;  // 95 %, of the active model
  bool in_contact = false;
  bool counts = true;          // in contact, valid sample, filters settled; see comparison.h for the rest
  bool out_of_domain = false;  // of the active model
  std::uint8_t active = 0;     // its slot
  TickFaultLevel fault_level = TickFaultLevel::none;
  // By slot: the force; the mean over 50 ms of (model - reference) / JND (SustainedError), signed; its largest
  // magnitude since this press began.
  std::array<float, kMaxModels> force_N = no_values(), sustained_over_jnd = no_values(), press_over_jnd = no_values();
  std::uint16_t other_material = 0;  // bit per slot: a model of another material, which is not compared

  // (model - reference) / JND of this tick; 0 in the air, NaN without a comparison.
  double difference_over_jnd(std::size_t slot, const JndLine& jnd) const noexcept {
    const bool none = std::isnan(reference_N) || std::isnan(force_N[slot]) || (other_material >> slot & 1U) != 0;
    if (none || (in_contact && !counts)) return std::numeric_limits<double>::quiet_NaN();
    const double from_N = reference_N;
    return in_contact ? (force_N[slot] - from_N) / jnd.at(from_N) : 0.0;
  }
};

class ForceHistory {
 public:
  // `capacity`: allocated once, so that a session of hours does not grow; by default one point per millisecond.
  explicit ForceHistory(std::size_t capacity = static_cast<std::size_t>(kHistory_s * 1000.0)) : points_(capacity) {}

  std::size_t size() const noexcept { return size_; }
  // 0 is the oldest.
  const HistoryPoint& operator[](std::size_t index) const noexcept {
    const std::size_t at = first_ + index;
    return points_[at < points_.size() ? at : at - points_.size()];
  }
  // Index of the first point at `loop_time_s` or later; size() if there is none. O(log size).
  std::size_t first_at(double loop_time_s) const noexcept {
    std::size_t from = 0;
    for (std::size_t to = size_; from < to;) {
      const std::size_t middle = from + (to - from) / 2;
      const bool before = (*this)[middle].loop_time_s < loop_time_s;
      (before ? from : to) = before ? middle + 1 : middle;
    }
    return from;
  }
  // The last point up to `loop_time_s`; null: there is none.
  const HistoryPoint* last_until(double loop_time_s) const noexcept {
    const std::size_t next = first_at(std::nextafter(loop_time_s, std::numeric_limits<double>::infinity()));
    return next > 0 ? &(*this)[next - 1] : nullptr;
  }
  void forget(std::size_t slot) noexcept {
    for (HistoryPoint& point : points_)
      point.force_N[slot] = point.sustained_over_jnd[slot] = point.press_over_jnd[slot] = kMissing;
  }
  void append(const HistoryPoint& point) {
    if (size_ < points_.size()) {
      points_[size_++] = point;
    } else {
      points_[first_] = point;
      first_ = (first_ + 1) % points_.size();
    }
  }

 private:
  std::vector<HistoryPoint> points_;
  std::size_t first_ = 0, size_ = 0;
};

// The errors of one model over an endless stream of ticks: constant time per tick and bounded memory. The 99 % error
// (scenes/evaluation/model_errors.h) is rounded up by at most 1.1 %, never across 1.
class StreamErrors {
 public:
  // Adds one sample in contact. Both forces are finite.
  void add(double model_N, double reference_N, const JndLine& jnd);
  ErrorSummary summary(const JndLine& jnd) const;

 private:
  // The number of errors over the JND in logarithmic bins from 1/1024 to 1024 JND; 1 is the edge of a bin.
  static constexpr double kPerOctave = 64.0;
  static constexpr double kBelow = 10.0 * kPerOctave;
  static constexpr double kBins = 2.0 * kBelow + 1.0;
  std::array<std::uint32_t, static_cast<std::size_t>(kBins)> counts_{};
  ErrorFigures figures_;
};

// The perceivable error: the mean of (model - reference) / JND over the last 50 ms. A difference of a single
// millisecond moves neither hand nor skin, but one that lasts does.
class SustainedError {
 public:
  static constexpr double kSpan_s = 0.05;

  // `difference_over_jnd`: signed, finite. The window restarts where `time_s` decreases or has a gap longer than
  // the span. Returns the mean, signed.
  double add(double time_s, double difference_over_jnd);

 private:
  std::deque<std::pair<double, double>> samples_;  // time, s, and difference
  double sum_ = 0.0;
};

// The perceivable errors of all slots, and the largest ones of each press. A press ends with 0.2 s in the air, not with
// a loss of contact by noise.
class NoticedErrors {
 public:
  // Call it for every tick in order. Sets sustained_over_jnd and press_over_jnd where there is a comparison.
  void add(HistoryPoint& point, const JndLine& jnd);
  // The newest one, signed; ticks without a comparison count as 0.
  double sustained_over_jnd(std::size_t slot) const noexcept { return slots_[slot].sustained_over_jnd; }
  void forget(std::size_t slot) { slots_[slot] = {}; }

 private:
  struct Slot {
    SustainedError error;
    double sustained_over_jnd = 0.0, press_over_jnd = 0.0;
  };
  std::array<Slot, kMaxModels> slots_;
  double last_contact_s_ = -std::numeric_limits<double>::infinity();  // device time
};

// The depth and the error colour of the dent that is drawn for one model. While the model pushes the tool, its surface
// is at the tool, so the dent has the tool's depth d. When the force ends, the surface recovers from there with the
// relaxation times tau_b of the model's features, and the tool dents it again where it is deeper:
//   dent = max(d, mean_b m_b),   m_b <- d while the force is above 0, else m_b exp(-h / tau_b)
// A model without relaxation times has the dent d. The colour is that of the largest recent error, which decays with
// a time constant of 0.3 s. No force depends on the dent.
class Dent {
 public:
  Dent() = default;
  explicit Dent(const std::vector<FeatureSpec>& features);

  // `force_N`: of the model; NaN: unknown. `error_over_jnd`: >= 0. `step_s`: time since the last call, s.
  void step(double depth_m, double force_N, double error_over_jnd, double step_s);

  double depth_m() const noexcept { return dent_m_; }
  double error_over_jnd() const noexcept { return error_over_jnd_; }

 private:
  struct Branch {
    double relaxation_time_s = 0.0, depth_m = 0.0;
  };
  std::vector<Branch> branches_;
  double dent_m_ = 0.0, error_over_jnd_ = 0.0;
};

// The true force of a scene's virtual material under the same tool: the reference of a session without a force sensor.
// A replayed recording has its own measured force instead.
class TrueForce final : public ReferenceForce {
 public:
  explicit TrueForce(const Material& material) : block_(material.make_block()) {}

  // At the first step, and at one with `restart`, the block is fully relaxed under the tool. The filters of the
  // models begin in the same state.
  double step(const TickSnapshot& snapshot, bool restart) noexcept override {
    if (restart || !started_) {
      block_->reset(snapshot.position_m);
      time_s_ = snapshot.time_s;
      started_ = true;
      return block_->force_N();
    }
    // A time that is not later leaves the block and its force unchanged.
    const double force_N = block_->step(snapshot.position_m, snapshot.velocity_m_per_s, snapshot.time_s - time_s_);
    if (snapshot.time_s > time_s_) time_s_ = snapshot.time_s;
    return force_N;
  }

 private:
  std::unique_ptr<Block> block_;
  double time_s_ = 0.0;
  bool started_ = false;
};

// Time of a tick, ns, and 99 % error over the JND of a model with each number of centres that was tested.
using CentresPath = std::map<int, std::pair<double, double>>;

// The state and the errors of one slot's model, for display.
struct ModelFigures {
  // The values of the newest tick; 0 until the model is ready.
  double force_N = 0.0;
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();  // of the force, 95 %; NaN: unknown
  bool out_of_domain = false;
  // Over the same samples for all compared models: those of the test (ModelTest); without a recording to test on,
  // those of the ticks (StreamErrors).
  ErrorSummary errors;
  Interval p99_interval{kUnknown, kUnknown};  // of the test
  Timing tick;                                // a whole tick with this model alone
  CentresPath path;
  double tick_ns() const noexcept { return tick.median_ns; }
  // Of the Dent: its depth, and the largest recent magnitude of the sustained error.
  double dent_m = 0.0, recent_error_over_jnd = 0.0;
};

// A sample counts if it is in contact and valid, the reference is known, no compared model is outside its training
// domain, and the feature filters have settled: a sample of the stream was out of contact, the stream began with the
// recording, or it has run for 5 times the longest relaxation time of the models.
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
    StreamErrors errors;
  };
  HistoryPoint point_of(const LoopSnapshot& snapshot, const PublishedSet* set);
  void count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set, double step_s);

  const SessionModels& models_;
  JndLine jnd_;
  ReferenceKind reference_;
  std::vector<Slot> slots_{kMaxModels};
  NoticedErrors noticed_;
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
