// Rows of a recording that say nothing of the material, found and left out before anything is computed:
// dropouts and repeated positions.
//
// Dropout: up to three rows on end with one value that leaves the course of the position or of the force and
// comes back. Its distance from the median of itself and its two neighbours exceeds six times the noise and six
// times the 90 % quantile of these distances, and three times what the signal changes beside it. A position
// must also need more than 100 m/s^2 for it; at rates where that is no argument, and of a force below
// 100 Hz, three such rows must have exactly the same value. Fewer than three rows, or more than a tenth
// of all, are no dropouts.
//
// Repeated positions: a position channel that is slower than the rows. Its changes come at equal intervals of
// two rows or more, whatever the speed; those of an encoder come faster in faster motion, by one
// step. Only the rows with an update are used, at rest every so many rows.
// Thread guarantee: slow side, pure but for read_usable_recording (does I/O).
#pragma once

#include <cstddef>
#include <string>

#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

struct RecordingFaults {
  std::size_t rows = 0;  // recorded
  std::size_t position_dropouts = 0;
  std::size_t force_dropouts = 0;
  double update_step_s = 0.0;  // between updates of the position; 0: every row has its own
  std::size_t updates = 0;

  bool any() const { return position_dropouts + force_dropouts > 0 || update_step_s > 0.0; }
};

// Takes the rows out of `recording`.
RecordingFaults remove_faults(Recording& recording);

// A recording without such rows. Errors: those of read_recording.
Result<Recording> read_usable_recording(const std::string& path, std::size_t most_rows = kAllRows,
                                        RecordingFaults* faults = nullptr);

}  // namespace palpate
