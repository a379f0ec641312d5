// The rules for the rows of a recording, used by reader and writer. Internal to engine/recording.
// Thread guarantee: slow side only; one thread per object.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/recording/recording.h"

namespace palpate {

// The role of a column of the file; the order is that of RecordingRow.
enum class ColumnRole : std::uint8_t { kTime, kPosition, kForce, kVelocity, kAcceleration, kIgnored };

inline constexpr std::size_t kKnownColumns = 5;
inline constexpr std::size_t kRequiredColumns = 3;
inline constexpr std::array<std::string_view, kKnownColumns> kColumnNames = {
    "time_s", "position_m", "force_N", "velocity_m_per_s", "acceleration_m_per_s2"};
inline std::array<double, kKnownColumns> column_values(const RecordingRow& row) {
  return {row.time_s, row.position_m, row.force_N, row.velocity_m_per_s, row.acceleration_m_per_s2};
}

// No haptic device has a workspace of a metre: a larger value is in a wrong unit, mostly millimetres.
inline constexpr double kMaximumPosition_m = 1.0;
// The weight of a hundred tonnes: a larger value is in a wrong unit, or the sensor is broken.
inline constexpr double kMaximumForce_N = 1e6;
// The range of sampling rates. The median step is compared, with a tolerance for slow clocks and for times rounded to
// few digits; single steps may be of any length.
inline constexpr double kMinimumRate_Hz = 10.0;
inline constexpr double kMaximumRate_Hz = 20000.0;
inline constexpr double kRateTolerance = 0.05;
// Whether rows with this time step have a rate in that range.
bool rate_in_range(double step_s);
// Limit of the length of a line, bytes; it bounds the memory of the reader.
inline constexpr std::size_t kMaximumLineBytes = 64 * 1024;
// The rate is checked once, after this many rows, so that rows can be streamed.
inline constexpr std::size_t kRateRows = 1000;

// A broken rule: "found ..., expected ...; what to do", and its position.
struct RowFault {
  enum class Place { kThisRow, kFirstRow, kEnd };
  Place place = Place::kThisRow;
  ColumnRole role = ColumnRole::kTime;
  std::string text;
};

// Checks rows in order: `check` for every row, then `finish`.
class RowRules {
 public:
  // Returns nothing, or the rule that `row` breaks: a value that is not finite, a position or force beyond the limits
  // above, a time that is not later than that of the row before; for row kRateRows also a rate outside the range.
  std::optional<RowFault> check(const RecordingRow& row) {
    // A comparison with NaN is false, so NaN is rejected, too.
    const bool sane = row.time_s > last_time_s_ && row.time_s < HUGE_VAL &&
                      std::abs(row.position_m) <= kMaximumPosition_m && std::abs(row.force_N) <= kMaximumForce_N &&
                      std::abs(row.velocity_m_per_s) < HUGE_VAL && std::abs(row.acceleration_m_per_s2) < HUGE_VAL;
    if (!sane) return explain(row);
    if (rows_ < kRateRows) return accept_early(row);
    last_time_s_ = row.time_s;
    ++rows_;
    return std::nullopt;
  }

  // To be called after the last row. Detects fewer than kRecordingMinimumRows rows, and a rate outside the range in a
  // recording with fewer than kRateRows rows.
  std::optional<RowFault> finish();

  std::uint64_t rows() const { return rows_; }

 private:
  RowFault explain(const RecordingRow& row) const;
  std::optional<RowFault> accept_early(const RecordingRow& row);
  std::optional<RowFault> check_rate();

  double last_time_s_ = -HUGE_VAL;
  std::uint64_t rows_ = 0;
  std::vector<double> steps_s_;
};

}  // namespace palpate
