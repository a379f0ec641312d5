// The forces of the last kHistory_s at 1 kHz, for curves: one point per tick that read a sample.
// Thread guarantee: one thread.
#pragma once

#include <algorithm>
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
  // By slot: the force, and the mean over 50 ms of (model - reference) / JND (SustainedError), signed.
  std::array<float, kMaxModels> force_N = no_values(), sustained_over_jnd = no_values();
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
  // Capacity: one point per millisecond, allocated once: a session of hours does not grow.
  ForceHistory() : points_(static_cast<std::size_t>(kHistory_s * 1000.0)) {}

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
    for (HistoryPoint& point : points_) point.force_N[slot] = point.sustained_over_jnd[slot] = kMissing;
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

}  // namespace palpate
