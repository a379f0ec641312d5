// The last minutes of forces, one point a tick, for curves.
//
// Thread guarantee: one thread; `append` allocates nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/live/fault_log.h"

namespace palpate {

inline constexpr double kHistory_s = 120.0;

struct HistoryPoint {
  double loop_time_s = 0.0;  // steady clock
  double time_s = 0.0;       // the device's: of a recording that is stepped, its own
  float depth_m = 0.0F;
  float reference_N = 0.0F;  // NaN: none
  float rendered_N = 0.0F;
  float predicted_error_N = 0.0F;  // 95 %, of the active model; NaN: none
  std::uint8_t reference = 0;      // which it was, a ReferenceKind
  bool in_contact = false;
  bool counts = true;          // in contact: among the samples that figures are made of
  bool out_of_domain = false;  // of the active model
  std::uint8_t active = 0;     // its slot
  TickTrouble trouble = TickTrouble::none;
  std::array<float, kMaxModels> force_N{};  // by slot; NaN: not ready
  std::uint16_t foreign = 0;                // bits by slot: models with nothing to compare with

  // (model - reference) / JND: what curves and figures are made of. 0 in the air, NaN where
  // there is nothing to compare.
  double difference_over_jnd(std::size_t slot, const JndLine& jnd) const noexcept;
};

class ForceHistory {
 public:
  ForceHistory();

  std::size_t size() const noexcept { return size_; }
  // 0 is the oldest.
  const HistoryPoint& operator[](std::size_t index) const noexcept {
    const std::size_t at = first_ + index;
    return points_[at < points_.size() ? at : at - points_.size()];
  }
  // The first point at `loop_time_s` or later; size() when there is none. O(log).
  std::size_t first_at(double loop_time_s) const noexcept;
  // The last point up to `loop_time_s`; null: there is none.
  const HistoryPoint* last_until(double loop_time_s) const noexcept;
  void append(const HistoryPoint& point);

 private:
  std::vector<HistoryPoint> points_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace palpate
