// The last minutes of forces, one point a tick, for curves.
//
// Thread guarantee: one thread; `append` allocates nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/haptics_tick.h"
#include "scenes/live/fault_log.h"

namespace palpate {

inline constexpr double kHistory_s = 120.0;

struct HistoryPoint {
  double loop_time_s = 0.0;  // steady clock
  float depth_m = 0.0F;
  float reference_N = 0.0F;  // NaN: none
  float rendered_N = 0.0F;
  float predicted_error_N = 0.0F;  // 95 %, of the active model; NaN: none
  bool in_contact = false;
  bool out_of_domain = false;  // of the active model
  std::uint8_t active = 0;     // its slot
  TickTrouble trouble = TickTrouble::none;
  std::array<float, kMaxModels> force_N{};  // by slot; NaN: not ready
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
  void append(const HistoryPoint& point);

 private:
  std::vector<HistoryPoint> points_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace palpate
