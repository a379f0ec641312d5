// Gathers ticks into the columns of a plot. A column has the extremes of the differences, so that no peak is lost; its
// forces and its predicted error are those of one tick.
// Thread guarantee: value type; `gather` reuses its memory.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/live/force_history.h"

namespace palpate {

struct CurveColumn {
  double time_s = 0.0;                                // loop time of its middle
  bool any = false;                                   // whether it has ticks
  TickFaultLevel fault_level = TickFaultLevel::none;  // the worst of its ticks
  // The tick in which a model is farthest from the reference. All forces that are drawn are of this one tick, so that
  // no difference is shown that did not occur.
  HistoryPoint tick;
  float jnd_N = kMissing;  // at that tick; NaN: no reference
  // By slot: extremes of (model - reference) / JND, signed; 0 out of contact, NaN without a force or a comparison.
  std::array<float, kMaxModels> low_over_jnd = no_values();
  std::array<float, kMaxModels> high_over_jnd = no_values();
  std::array<float, kMaxModels> sustained_over_jnd =
      no_values();  // largest magnitude of HistoryPoint::sustained_over_jnd
};

// The error (95 %) that the active model predicts of its force, 0 out of contact; NaN: there is none, or there is a
// reference.
double predicted_error_N(const HistoryPoint& tick) noexcept;

class CurveColumns {
 public:
  // Gathers the ticks from `from_s` to `to_s` (loop time) into columns of a width of (to_s - from_s) / count. Borders
  // are multiples of the width, so that curves do not flicker while they scroll: there are count + 2 columns. As long
  // as the width stays the same, a call processes only new ticks.
  void gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s, double to_s,
              std::size_t count);

  const std::vector<CurveColumn>& columns() const noexcept { return columns_; }
  // The column at a time; null: there is none, or it has no ticks.
  const CurveColumn* at(double time_s) const noexcept;
  // The newest column with ticks; null: there is none.
  const CurveColumn* last() const noexcept;
  // The largest over all columns and slots; 0 without ticks.
  float highest_force_N() const noexcept { return highest_force_N_; }
  float highest_sustained_over_jnd() const noexcept { return highest_sustained_; }

 private:
  bool scroll(double width_s, double first, std::size_t slots, std::size_t count);
  void add(const HistoryPoint& point, const JndLine& jnd, CurveColumn& column);
  void find_highest();

  std::vector<CurveColumn> columns_;
  std::size_t slots_ = 0;
  double width_s_ = 0.0;
  double first_ = 0.0;    // left border of the first column, in widths
  double taken_s_ = 0.0;  // loop time of the last tick that was gathered
  float highest_force_N_ = 0.0F, highest_sustained_ = 0.0F;
};

}  // namespace palpate
