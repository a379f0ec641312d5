// A hash of the numbers of a recording (FNV-1a with an additional shift), independent of its name.
// Thread guarantee: value types and pure functions.
#pragma once

#include <bit>
#include <cstdint>

#include "engine/recording/recording.h"

namespace palpate {

// Computes the hash row by row, for recordings that are not in memory.
class ContentHash {
 public:
  void add(const RecordingRow& row) {
    for (const double value :
         {row.time_s, row.position_m, row.force_N, row.velocity_m_per_s, row.acceleration_m_per_s2}) {
      value_ = (value_ ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3ULL;
      value_ ^= value_ >> 29;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

inline std::uint64_t content_hash(const Recording& recording) {
  ContentHash hash;
  for (const RecordingRow& row : recording.rows) hash.add(row);
  return hash.value();
}

}  // namespace palpate
