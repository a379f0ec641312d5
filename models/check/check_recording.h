// Checks whether a recording is suitable for a fit; palpate check, fit, replay and report use the same findings. Fatal
// ones make a fit meaningless: a flipped sign, no force, no motion, no contact. Notes are measured values. Thread
// guarantee: slow side, pure but for check_recording_file (does I/O).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/samples/samples.h"
#include "models/samples/selection.h"

namespace palpate {

// Measures of the sampling, the force and the motion of a recording, and the figures of merit that its noise permits.
// Thread guarantee: slow side, pure.

// Cells of depth and speed. The edges of the speed bands are relative to the greatest depth: 10 and 50 mm/s where that
// is 10 mm. The depth is divided into quarters.
inline constexpr std::size_t kDepthQuarters = 4;
inline constexpr std::size_t kSpeedBands = 3;
inline constexpr std::array<double, kSpeedBands - 1> kSpeedEdges_per_s = {1.0, 5.0};
// A cell (depth quarter x speed band) with less time counts as not visited.
inline constexpr double kLeastCell_s = 0.05;

struct RecordingMeasures {
  double duration_s = 0.0, median_step_s = 0.0, largest_step_s = 0.0, largest_step_at_s = 0.0;
  double lowest_position_m = 0.0, highest_position_m = 0.0, lowest_force_N = 0.0, highest_force_N = 0.0;
  // Clipping: the number of rows at exactly the greatest force, in runs of at least three, and the largest range of
  // positions in one run.
  std::size_t flat_rows = 0;
  double flat_travel_m = 0.0;
  // The range of positions in a run of rows with another force above half of the greatest, which 90 % of these runs do
  // not exceed; 0 unless the force is quantised or held.
  double step_travel_m = 0.0;
  // Contact begins at the given surface, or at the lowest position if that is deeper.
  double outermost_contact_m = 0.0;
  std::size_t contact_rows = 0;
  int strokes = 0;
  double inward_travel_m = 0.0, outward_travel_m = 0.0;
  int small_strokes = 0;        // in contact, with a length of 5 to 40 % of the greatest depth
  double longest_hold_s = 0.0;  // in contact, moving by less than 2 % of the depth
  double hold_change_N = 0.0;   // of the force from the middle to the end of that hold, means of a tenth of its rows
  double hold_end_N = 0.0;      // the force at its end
  std::array<std::array<double, kSpeedBands>, kDepthQuarters> seconds{};  // depth x speed
};

RecordingMeasures measure_recording(const Recording& recording, double surface_m);

// The white noise of the force, N. PreparedRecording::force_noise_N is that of the quietest fifth of windows of 50
// rows, which for white noise is the 0.2 quantile of its estimates, 0.87 of the standard deviation (simulated, 20,000
// windows).
double white_force_noise_N(const PreparedRecording& prepared);
// Whether these second differences are those of white noise: with their neighbours they correlate by -2/3, and by more
// where motion or a filter changes the force between rows. In nine simulated materials with 5 mN of white noise it is
// -0.41 to 0.57 at 10 to 100 Hz (the estimate is 1.8 times too high and more) and -0.58 to -0.60 from 500 Hz on; the
// limit of -0.45 leaves 38 of 54 public recordings. False with fewer rows than a window.
bool is_force_noise_known(const PreparedRecording& prepared);

// How the force zero changes over a recording, from groups of its rows in free air, of equal size: a line and a step.
// f(t) = a + b t + c H(t - t0) is fitted to the medians of the groups.
struct ZeroDrift {
  double range_N = 0.0;                     // largest minus smallest median
  double standard_error_N = kUnknownError;  // of a median
  double line_N = 0.0;                      // b times the duration
  double step_N = 0.0, step_at_s = 0.0;     // c and t0; 0 without a step that lowers the error to less than half
};
ZeroDrift find_zero_drift(const PreparedRecording& prepared);

// The lag of the force behind the position, of at most kMostLag_s either way. `rows`: of a recording,
// in time order; uses 4000 that are at least 5 ms apart, of a longer recording in five windows. `at` > 0 s: the force
// is late; 0 if the data do not identify a lag (models/samples/selection.h), with fewer than 100 rows or three strokes,
// or with rows too far apart. The standard error includes the interval of the rows. A lag at the end of the search is
// kMostLag_s, with an infinite error.
inline constexpr double kMostLag_s = 1.0;
inline constexpr double kNearLag_s = 0.05;  // searched in fine steps, and by every row
OffsetEstimate find_force_lag(const std::vector<Sample>& rows, double force_noise_N);

// The figures of merit of a perfect model, whose error e is normal with the standard deviation s of the force sensor:
//   within the JND = mean over the samples of P(|e| <= JND(f));  99 % error: the q with mean P(|e| <= q JND(f)) = 0.99
struct NoiseFloor {
  bool known = true;           // false: the noise of a recording is not, and the figures limit nothing
  double force_noise_N = 0.0;  // RMS of s over the samples in contact
  double within_jnd = 1.0, p99_error_over_jnd = 0.0;
};

// Uses the samples in contact of all `recordings`, at most 10,000 rows of each, evenly spaced. Contact begins at the
// estimated surface, and forces count from the estimated force zero.
NoiseFloor noise_floor(const std::vector<const PreparedRecording*>& recordings, const JndLine& jnd);

enum class Severity { note, warning, fatal };
const char* severity_name(Severity severity);

struct Finding {
  std::string code;  // stable identifier for programs: "force_sign"
  Severity severity = Severity::note;
  double value = 0.0;  // the number in `text`, SI
  std::string text;    // what was found
  std::string advice;  // may be empty
};

// "code: text; advice".
std::string finding_text(const Finding& finding);

// The intended use of the recording.
struct CheckRequest {
  JndLine jnd;
  bool memory = false;  // the force of the scene's material depends on the past
};
// `features`: of the scene.
CheckRequest check_request(const JndLine& jnd, const std::vector<FeatureSpec>& features);

struct RecordingCheck {
  std::vector<Finding> findings;  // in order of severity, fatal first
  // The share of contact samples within the JND that a perfect model would have with this force noise.
  double noise_floor_within_jnd = 1.0;
  bool surface_identified = false;
  double surface_offset_m = 0.0;  // to be subtracted from position_m; 0 if not identified
  double force_zero_N = 0.0;      // to be subtracted from force_N
  RecordingMeasures measures;

  // "usable", "care" (at least one warning) or "unusable" (at least one fatal finding).
  const char* verdict() const;
};

// `prepared`: at least kRecordingMinimumRows rows. `faults`: the rows that were removed from it.
RecordingCheck check_recording(const PreparedRecording& prepared, const CheckRequest& request,
                               const RecordingFaults& faults = {});

struct CheckedFile {
  std::string path;
  PreparedRecordingPointer prepared;  // the checked rows, without its faults
  RecordingCheck check;

  const Recording& recording() const { return prepared->recording; }
};

// Errors: those of read_recording.
Result<CheckedFile> check_recording_file(const std::string& path, const CheckRequest& request);
// The median difference of the forces of two recordings of one set, second minus first, N, if no single model can
// render both; else none: the central 90 % of their forces do not overlap in four of five bins of their positions, and
// the median difference exceeds two JND. Positions count from the surfaces where both are clear, as in a fit.
std::optional<double> find_contradiction_N(const PreparedRecording& first, const PreparedRecording& second,
                                           const JndLine& jnd);
// Checks several recordings of one set. Equal rows, and forces that contradict those of another recording, are findings
// of the later one. Errors: those of the first file that cannot be read.
Result<std::vector<CheckedFile>> check_recording_files(const std::vector<std::string>& paths,
                                                       const CheckRequest& request);
// The recordings of checked files, for a fit.
std::vector<PreparedRecordingPointer> training_recordings(std::vector<CheckedFile> files);
// An error with the fatal findings of the first unusable file: "path: position_sign: ...; ...; force_sign: ...; ...".
Status refuse_unusable(const std::vector<CheckedFile>& files);
// The recording that `tests` continue. Errors: those of read_recording; one of `tests` has the same rows.
Result<Recording> read_recording_before(const std::string& path, std::span<const CheckedFile> tests);
// One line for each warning: "path: gap: ...; ...".
std::vector<std::string> warning_lines(const std::vector<CheckedFile>& files);

}  // namespace palpate
