// The last minutes of forces, one point a tick, for curves.
// Thread guarantee: one thread; `append` allocates nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "scenes/live/fault_log.h"

namespace palpate {

inline constexpr double kHistory_s = 120.0;

// What the models are compared with.
enum class ReferenceKind : std::uint8_t {
  measured,  // the force in the recording that is replayed
  truth,     // of the scene's virtual material under the same tool
  direct,    // a model: the direct interpolant, all sites; of files without one, the first
};
inline constexpr std::array<ReferenceKind, 3> kReferenceKinds{ReferenceKind::measured, ReferenceKind::truth,
                                                              ReferenceKind::direct};

struct HistoryPoint {
  double loop_time_s = 0.0;  // steady clock
  double time_s = 0.0;       // the device's: of a recording that is stepped, its own
  float position_m = 0.0F;   // of the tool: negative in the air
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
  // (model - reference) / JND as its mean over 50 ms (sustained_error.h), signed; 0 in the air, NaN where
  // there is nothing to compare.
  std::array<float, kMaxModels> sustained_over_jnd{};
  std::uint16_t foreign = 0;  // bits by slot: models with nothing to compare with

  // (model - reference) / JND in this tick alone. 0 in the air, NaN where there is nothing to compare.
  double difference_over_jnd(std::size_t slot, const JndLine& jnd) const noexcept {
    const bool none = std::isnan(reference_N) || std::isnan(force_N[slot]) || (foreign >> slot & 1U) != 0;
    if (none || (in_contact && !counts)) return std::numeric_limits<double>::quiet_NaN();
    const auto from_N = static_cast<double>(reference_N);
    return in_contact ? (static_cast<double>(force_N[slot]) - from_N) / jnd.at(from_N) : 0.0;
  }
};

class ForceHistory {
 public:
  // One a millisecond.
  ForceHistory() : points_(static_cast<std::size_t>(kHistory_s * 1000.0)) {}

  std::size_t size() const noexcept { return size_; }
  // 0 is the oldest.
  const HistoryPoint& operator[](std::size_t index) const noexcept {
    const std::size_t at = first_ + index;
    return points_[at < points_.size() ? at : at - points_.size()];
  }
  // The first point at `loop_time_s` or later; size() when there is none. O(log).
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
  // The slot's model is gone.
  void forget(std::size_t slot) noexcept {
    for (HistoryPoint& point : points_) point.force_N[slot] = point.sustained_over_jnd[slot] = std::nanf("");
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
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace palpate
