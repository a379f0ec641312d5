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
  double time_s = 0.0;  // of its middle, loop time
  bool any = false;     // has ticks
  bool reference = false;
  bool contact = false;
  TickTrouble trouble = TickTrouble::none;  // the worst
  float reference_N = 0.0F;                 // the last one
  float band_low_N = 0.0F;                  // reference -/+ JND, outermost
  float band_high_N = 0.0F;
  std::array<float, kMaxModels> low_N{};  // NaN: no force
  std::array<float, kMaxModels> high_N{};
  std::array<float, kMaxModels> error_over_jnd{};  // largest, in contact; NaN: none
};

class CurveColumns {
 public:
  // The ticks from `from_s` to `to_s` in `count` columns. The columns' borders are
  // whole multiples of their width, so that curves scroll without shimmering.
  void gather(const ForceHistory& history, const JndLine& jnd, std::size_t slots, double from_s, double to_s,
              std::size_t count);

  const std::vector<CurveColumn>& columns() const noexcept { return columns_; }
  // Over all columns and slots; 0 without.
  float highest_force_N() const noexcept { return highest_force_N_; }
  float highest_error_over_jnd() const noexcept { return highest_error_; }

 private:
  void take(const HistoryPoint& point, const JndLine& jnd, std::size_t slots, CurveColumn& column);

  std::vector<CurveColumn> columns_;
  float highest_force_N_ = 0.0F;
  float highest_error_ = 0.0F;
};

}  // namespace palpate
