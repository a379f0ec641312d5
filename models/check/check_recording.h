// Is this recording fit to be fitted? One answer, and findings with a number, why it
// matters and what to do, for palpate check, fit, replay and report alike.
//
// Fatal is what makes a fit meaningless: a flipped sign, no force, no motion, no
// contact. Warnings are what a fit survives and its user should know;
// notes say what was measured.
// Thread guarantee: slow side, pure but for check_recording_file (does I/O).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"
#include "engine/tick/motion_estimator.h"
#include "models/check/recording_measures.h"
#include "models/recordings/recording_faults.h"
#include "models/training/motion_source.h"

namespace palpate {

enum class Severity { note, warning, fatal };
const char* severity_name(Severity severity);

struct Finding {
  std::string code;  // stable, for programs: "force_sign"
  Severity severity = Severity::note;
  double value = 0.0;  // SI, of what `text` says
  std::string text;    // what was found
  std::string advice;  // what to do; may be empty
};

// What the recording is wanted for.
struct CheckRequest {
  JndLine jnd;
  std::vector<double> relaxation_times_s;  // of the scene; empty: no memory
};

struct RecordingCheck {
  std::vector<Finding> findings;  // the gravest first
  // The share of contact samples that a perfect model would have within the JND, given
  // the force noise: mean of P(|noise| <= JND(f)).
  double noise_floor_within_jnd = 1.0;
  bool surface_told = false;
  double surface_offset_m = 0.0;   // to be subtracted from position_m; 0 where it is not told
  double force_zero_N = 0.0;       // to be subtracted from force_N
  std::uint64_t content_hash = 0;  // of all rows; equal for copies under other names
  // Of all rows, as a fit estimates it, when the check had to know it; otherwise empty.
  std::vector<MotionEstimate> motion;
  RecordingMeasures measures;

  // "usable", "care" (a warning) or "unusable" (fatal).
  const char* verdict() const;
};

// `recording`: at least kRecordingMinimumRows rows.
// `faults`: what was left out of it.
RecordingCheck check_recording(const Recording& recording, const CheckRequest& request,
                               const RecordingFaults& faults = {});

// Longer recordings are checked by their first rows: 100 minutes at 1 kHz.
inline constexpr std::size_t kMostCheckedRows = 6000000;

struct CheckedFile {
  std::string path;
  Recording recording;  // what was checked, without its faults
  bool whole = true;    // false: the file is longer than kMostCheckedRows
  RecordingCheck check;
  std::vector<bool> left_out{};  // MotionSource::Input
};

// Errors: those of RecordingReader.
Result<CheckedFile> check_recording_file(const std::string& path, const CheckRequest& request);

// Several recordings of one set; the same rows twice are a finding of the later one.
// Errors: those of the first file that cannot be read.
Result<std::vector<CheckedFile>> check_recording_files(const std::vector<std::string>& paths,
                                                       const CheckRequest& request);

// Files that were checked as training recordings: what the check has read and estimated
// need not be read and estimated again.
std::vector<MotionSource::Input> training_inputs(std::vector<CheckedFile> files);

// An error of the first fatal finding: "path: force_sign: ...; ...".
Status refuse_unusable(const std::vector<CheckedFile>& files);
// One line for each warning: "path: gap: ...; ...".
std::vector<std::string> warning_lines(const std::vector<CheckedFile>& files);

}  // namespace palpate
