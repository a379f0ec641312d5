// Checks whether a recording is suitable for a fit; palpate check, fit, replay and report use the same findings. Fatal
// ones make a fit meaningless: a flipped sign, no force, no motion, no contact. Notes are measured values. Thread
// guarantee: slow side, pure but for check_recording_file (does I/O).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/check/recording_measures.h"
#include "models/samples/recording_faults.h"
#include "models/samples/samples.h"

namespace palpate {

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
  // The share of contact samples within the JND that a perfect model would have with this force noise
  // (recording_measures.h).
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

// Only the first rows of a longer recording are checked and fitted: 100 minutes at 1 kHz.
inline constexpr std::size_t kMostCheckedRows = 6000000;

struct CheckedFile {
  std::string path;
  PreparedRecordingPointer prepared;  // the checked rows, without its faults
  bool whole = true;                  // false: the file is longer than kMostCheckedRows
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
// One line for each warning: "path: gap: ...; ...".
std::vector<std::string> warning_lines(const std::vector<CheckedFile>& files);

}  // namespace palpate
