// Rows of a table that share a time: the clock is coarser than the rows, or rows were written twice.
// Thread guarantee: pure function, slow side.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/recording/recording.h"

namespace palpate {

struct RepeatedTimes {
  std::size_t rows = 0;           // number of rows with the time of the row above
  bool copies = true;             // all of them have its position and force, too
  double mean_rate_Hz = 0.0;      // of evenly spaced rows
  double step_s = 0.0;            // median step of the times
  std::optional<double> rate_Hz;  // the same if the clock is coarse: equal steps, equally many rows for each time
};

// `rows`: times that do not fall.
RepeatedTimes find_repeated_times(const std::vector<RecordingRow>& rows);

}  // namespace palpate
