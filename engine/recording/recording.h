// The recording file: motion and force of a tool against time, as CSV.
//
// Columns: time_s, position_m, force_N required; velocity_m_per_s and acceleration_m_per_s2 optional; names exact, any
// order; further columns are ignored. Lines that begin with '#' before the header are comments. Time is strictly
// increasing; RowRules limits position, force, the median time step and the length of a line. CRLF, a UTF-8 byte order
// mark, a missing last newline, blank lines at the end, blanks around numbers and a leading '+' are accepted. All other
// faults are errors, file:line:column: found X, expected Y; what to do, for the first fault in the file, with columns
// counted in bytes from 1 (after a byte order mark). Numbers use '.' as decimal point in every locale.
// Thread guarantee: slow side only (allocates, does I/O); one thread per object.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <istream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/files.h"
#include "engine/base/result.h"

namespace palpate {

// One row. Position along the inward surface normal, 0 at the undisturbed surface, positive inside; force along the
// outward normal, positive when the block pushes the tool out.
struct RecordingRow {
  double time_s = 0.0, position_m = 0.0, force_N = 0.0;
  double velocity_m_per_s = 0.0;       // 0 where the column is absent
  double acceleration_m_per_s2 = 0.0;  // 0 where the column is absent
};

struct RecordingColumns {
  bool velocity = false, acceleration = false;
  bool force = true;  // false: motion alone, which only RecordingWriter supports
};

struct Recording {
  std::string name;  // file name without folder and ending
  RecordingColumns columns;
  std::vector<RecordingRow> rows;
};

// A hash of the numbers of a recording, independent of its name: FNV-1a with an additional shift. `before`: that of the
// rows before these.
inline constexpr std::uint64_t kHashOfNoRows = 0xCBF29CE484222325ULL;
std::uint64_t content_hash(const Recording& recording, std::uint64_t before = kHashOfNoRows);

inline constexpr std::size_t kRecordingMinimumRows = 10;
inline constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();

// Reads a recording, at most its first `most_rows` rows; 0: the header alone. Errors: no such file, a folder, a pipe or
// a device, not readable, not text, no header, a missing or duplicate column, a broken rule (RowRules).
Result<Recording> read_recording(const std::string& path, std::size_t most_rows = kAllRows);
// The same for any stream; `label` replaces the path.
Result<Recording> read_recording(std::istream& stream, const std::string& label, std::size_t most_rows = kAllRows);
// Reads a recording of any length in blocks of at most `block_rows` rows. `use`: called with one after the other while
// the next is read on another thread. Errors: as read_recording, after the blocks before the fault.
Status read_recording_blocks(const std::string& path, std::size_t block_rows,
                             const std::function<void(Recording block)>& use);

// Writes `recording` to `path` atomically (AtomicFile). Numbers read back as the same doubles. `comments` become '#'
// lines, one for each line of text. Errors: those of AtomicFile; a row or recording that breaks the rules above. Then
// no file is written.
Status write_recording(const std::string& path, const Recording& recording, const std::vector<std::string>& comments,
                       bool overwrite);

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
// Limit of the length of a line, bytes.
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
    if (rows_ > 0 && rows_ < kRateRows) steps_s_.push_back(row.time_s - last_time_s_);
    last_time_s_ = row.time_s;
    return ++rows_ == kRateRows ? check_rate() : std::nullopt;
  }

  // To be called after the last row. Detects fewer than kRecordingMinimumRows rows, and a rate outside the range in a
  // recording with fewer than kRateRows rows.
  std::optional<RowFault> finish();

  std::uint64_t rows() const { return rows_; }

 private:
  RowFault explain(const RecordingRow& row) const;
  std::optional<RowFault> check_rate();

  double last_time_s_ = -HUGE_VAL;
  std::uint64_t rows_ = 0;
  std::vector<double> steps_s_;
};

// The signs of position and force of a recording: the force of a contact grows with the depth and is nearly zero at the
// other, shallow end, or changes less there if an offset of the force hides that. The result is certain only with free
// air, a flat force at the shallow end; without it, a material that softens, drags or yields can look like a flipped
// sign.
struct PressDirection {
  bool known = false;             // whether the signs could be determined
  bool certain = false;           // there is free air, so that no material explains a flipped sign
  bool position_flipped = false;  // position decreases with depth
  bool force_flipped = false;     // force is negative when the material pushes the tool out
  double shallow_force_N = 0.0;   // mean over the shallowest samples
  double deep_force_N = 0.0;
};

PressDirection find_press_direction(const std::vector<RecordingRow>& rows);

// Writes a recording file of any length row by row in bounded memory. It gets its name at `commit`; the rows of a
// recording that is being made are in NAME.part until then (AtomicFile).
// Thread guarantee: slow side only; one thread at a time.

class RecordingWriter {
 public:
  // `comments` become '#' lines, one for each line of text. Errors: those of AtomicFile.
  static Result<RecordingWriter> create(const std::string& path, RecordingColumns columns,
                                        const std::vector<std::string>& comments, bool overwrite, bool in_part = false);

  // Buffered. Errors: a row that breaks a rule (engine/recording/recording.h); it is not written.
  Status add(const RecordingRow& row);

  std::uint64_t rows() const { return rules_.rows(); }
  // Whether an input/output error has occurred, which `commit` will return.
  bool failed() const noexcept { return file_.failed(); }

  // Adds the rows written so far to the part. Errors: as `commit`.
  Status flush();
  // The number of rows that `flush` has added.
  std::uint64_t flushed_rows() const noexcept { return flushed_rows_; }

  // Errors: those of AtomicFile::commit; fewer than 10 rows, or a rate outside the reader's range, which leave no file.
  Status commit();

 private:
  RecordingWriter(AtomicFile file, std::string path, RecordingColumns columns)
      : file_(std::move(file)), path_(std::move(path)), columns_(columns) {}

  AtomicFile file_;
  std::string path_;
  RecordingColumns columns_;
  RowRules rules_;
  std::uint64_t flushed_rows_ = 0;
};

}  // namespace palpate
