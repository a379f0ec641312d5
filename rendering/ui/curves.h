// Ticks gathered into the columns of a plot: extremes, so that no peak between
// two pixels is lost.
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
  double time_s = 0.0;                      // of its middle, loop time
  bool any = false;                         // has ticks
  TickTrouble trouble = TickTrouble::none;  // the worst
  // The tick in which a model is farthest from the reference: one moment for all that is
  // drawn and read of forces, so that no figure shows a difference that never was.
  HistoryPoint tick;
  float jnd_N = 0.0F;  // there; NaN: no reference
  // Without a reference: the active model's force -/+ its predicted error (95 %),
  // outermost, and that error over the JND; NaN: none.
  float predicted_low_N = 0.0F;
  float predicted_high_N = 0.0F;
  float predicted_over_jnd = 0.0F;
  // Of each model; NaN: no force, or nothing to compare it with.
  // (model - reference) / JND, signed; 0 out of contact.
  std::array<float, kMaxModels> low_over_jnd{};
  std::array<float, kMaxModels> high_over_jnd{};
  std::array<float, kMaxModels> error_over_jnd{};      // the largest of a single tick, in contact
  std::array<float, kMaxModels> sustained_over_jnd{};  // the largest of HistoryPoint's
};

class CurveColumns {
 public:
  // The ticks from `from_s` to `to_s` in `count` columns. The columns' borders are
  // whole multiples of their width, so that curves scroll without shimmering. What was
  // gathered before is kept as long as the columns stay the same: then a call costs as
  // many ticks as are new.
  void gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s, double to_s,
              std::size_t count);

  const std::vector<CurveColumn>& columns() const noexcept { return columns_; }
  // The column of a time; null: none, or one without ticks.
  const CurveColumn* at(double time_s) const noexcept;
  // The newest that has ticks; null: none has.
  const CurveColumn* last() const noexcept;
  // Over all columns and slots; 0 without.
  float highest_force_N() const noexcept { return highest_force_N_; }
  float highest_sustained_over_jnd() const noexcept { return highest_sustained_; }

 private:
  bool scroll(double width_s, double first, std::size_t slots, std::size_t count);
  void add(const HistoryPoint& point, const JndLine& jnd, CurveColumn& column);
  void add_model(const HistoryPoint& point, std::size_t slot, const JndLine& jnd, CurveColumn& column);
  void add_prediction(const HistoryPoint& point, const JndLine& jnd, CurveColumn& column);
  void find_highest();

  std::vector<CurveColumn> columns_;
  std::size_t slots_ = 0;
  double width_s_ = 0.0;
  double first_ = 0.0;    // number of the first column: its border, in widths
  double taken_s_ = 0.0;  // loop time of the last tick that was taken
  float highest_force_N_ = 0.0F;
  float highest_sustained_ = 0.0F;
};

}  // namespace palpate
