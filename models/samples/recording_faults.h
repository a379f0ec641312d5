// The one reader of rows for training: finds and removes rows of a recording without information about the material,
// before anything is computed. A test keeps all rows (read_recording), as does a device.
//
// Dropout: up to three consecutive rows with one value outside the range of their neighbours, by more than six times
// the noise, six times the 90 % quantile of such distances, eight times the scatter of the rows next to it (the noise
// at that force), and three times the change of the signal next to it. A position must also imply an acceleration above
// 100 m/s^2; otherwise, and for a force below 100 Hz, three dropouts must have exactly the same value. Fewer than
// three, or more than a tenth of all rows, are not removed.
//
// Held values: the position or the force is slower than the rows, which repeat its last value: it changes by several of
// its steps at once and then not for equal intervals of two rows or more, at any speed. Only the rows with an update
// are kept; at rest, rows at the same intervals. Of two slow channels the slower one determines the rows. Thread
// guarantee: slow side, pure but for read_usable_recording (does I/O).
#pragma once

#include <string>

#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

struct RecordingFaults {
  std::size_t rows = 0;               // number of recorded rows
  std::size_t position_dropouts = 0;  // number of rows
  std::size_t force_dropouts = 0;
  double update_step_s = 0.0;  // interval of the updates of a slow channel; 0: every row has its own values
  bool held_force = false;     // the slow channel is the force, not the position
  std::size_t updates = 0;     // number of rows with an update that were kept

  bool any() const { return position_dropouts + force_dropouts > 0 || update_step_s > 0.0; }
};

// Removes the rows from `recording`.
RecordingFaults remove_faults(Recording& recording);
// Reads a recording and removes such rows. `faults`: receives what was removed; may be null. Errors: those of
// read_recording.
Result<Recording> read_usable_recording(const std::string& path, std::size_t most_rows = kAllRows,
                                        RecordingFaults* faults = nullptr);

}  // namespace palpate
