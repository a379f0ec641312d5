// The recording file: motion and force of a tool against time, as CSV.
//
// Columns: time_s, position_m, force_N required; velocity_m_per_s and acceleration_m_per_s2 optional; names exact, any
// order; further columns are ignored. Lines that begin with '#' before the header are comments. Time is strictly
// increasing; recording_rules.h limits position, force, the median time step and the length of a line. CRLF, a UTF-8
// byte order mark, a missing last newline, blank lines at the end, blanks around numbers and a leading '+' are
// accepted. All other faults are errors,
//   file:line:column: found X, expected Y; what to do
// for the first fault in the file, with columns counted in bytes from 1 (after a byte order mark). Numbers use '.' as
// decimal point in every locale.
// Thread guarantee: slow side only (allocates, does I/O).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// One row. Position along the inward surface normal, 0 at the undisturbed surface, positive inside; force along the
// outward normal, positive when the block pushes the tool out.
struct RecordingRow {
  double time_s = 0.0;
  double position_m = 0.0;
  double force_N = 0.0;
  double velocity_m_per_s = 0.0;       // 0 where the column is absent
  double acceleration_m_per_s2 = 0.0;  // 0 where the column is absent
};

struct RecordingColumns {
  bool velocity = false;
  bool acceleration = false;
  bool force = true;  // false: motion alone, which only RecordingWriter supports
};

struct Recording {
  std::string name;  // file name without folder and ending
  RecordingColumns columns;
  std::vector<RecordingRow> rows;
};

// A hash of the numbers of a recording, independent of its name: FNV-1a with an additional shift.
std::uint64_t content_hash(const Recording& recording);

inline constexpr std::size_t kRecordingMinimumRows = 10;
inline constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();

// Reads a recording into memory, at most its first `most_rows` rows. Errors: those of RecordingReader.
Result<Recording> read_recording(const std::string& path, std::size_t most_rows = kAllRows);

// Writes `recording` to `path` atomically (AtomicFile). Numbers read back as the same doubles. `comments` become '#'
// lines, one for each line of text. Errors: those of AtomicFile; a row or recording that breaks the rules above. Then
// no file is written.
Status write_recording(const std::string& path, const Recording& recording, const std::vector<std::string>& comments,
                       bool overwrite);

}  // namespace palpate
