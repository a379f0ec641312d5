// The trials of a subject, whose order depends on the subject code only, and the answers.
//
// Constant stimuli: two-alternative forced choice (2AFC) without movement; which of two forces was larger? As in Hoever
// & Harders (2009), section 4.1: reference forces 0.3, 0.5, 1.0 and 2.5 N; comparison forces from 60 % to 140 % of the
// reference, eight values without 100 %; each pair ten times: 320 trials. Each pair comes once in every 32 trials,
// five times with the comparison first and five times second.
//
// Two strokes: 2AFC with a reminder (M. J. Hautus, N. A. Macmillan & C. D. Creelman 2022, Detection Theory: A User's
// Guide, 3rd ed., chapter 7; ISO 10399). The reference stroke is followed by reference and comparison in either order;
// which of the two was like the first? An observer who uses the difference performs as in 2AFC without a reminder, so
// that one JND is 75 % correct. The reminder is necessary because strokes may differ in any way, not only in size.
//
// The answers are in a CSV file, one row per trial. A session has no other copy of them.
//
//   # palpate-study 1
//   # subject S01
//   # procedure constant
//   # timing_ms lead_in 400 ramp 100 hold 900 pause 500
//   # consent accepted, 2024-05-06 10:20
//   part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,answer,response_ms,device,rendered
//   training,1,0.3,0.18,1,0.18,0.3,0,second,731,paddle,true
//
// The procedure discriminate has a line `# strokes {...}` after the timing, a StrokePair without its forces as JSON.
// Its rows have two more columns before the device, reminder_rendered_N and worst_N; their forces are the means of the
// strokes. The first five columns are those of the subject's plan.
//
// No file exists before the consent. With each answer the file is replaced atomically; the answer counts once the file
// is on the disk. A last row without its line end is ignored.
// Thread guarantee: one thread; slow side (does I/O).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/live/device.h"
#include "engine/live/handover.h"
#include "engine/recording/recording.h"
#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// Presents two forces one after the other with the accuracy of a tick, optionally after a third one as a reminder:
//   lead-in [-> reminder -> pause] -> first -> pause -> second
// Time is counted in ticks of 1 ms. Within an interval the force, constant or a stroke, is multiplied by a cosine ramp
// at its beginning and end. Outside of the intervals it is zero, so that no force lasts longer than its interval, even
// if the slow side hangs. A ForceLimiter limits the result to 4 N and 100 N/s; it also ramps the force down within
// 40 ms when a presentation is stopped. Positive forces push towards the hand.
// Thread guarantee: `tick` on the haptics thread, `stop` on any, both wait-free and without allocation; the rest on one
// slow thread.

inline constexpr double kLargestStudyForce_N = 4.0;
inline constexpr double kFastestStudyForce_N_per_s = 100.0;
// Durations in ticks. The ramp stays below the limiter's slew rate: 3.5 N x pi / 2 / 100 ms = 55 N/s.
inline constexpr std::uint32_t kLeadIn_ticks = 400;
inline constexpr std::uint32_t kRamp_ticks = 100;
inline constexpr std::uint32_t kHold_ticks = 900;
inline constexpr std::uint32_t kPause_ticks = 500;
inline constexpr std::uint32_t kInterval_ticks = 2 * kRamp_ticks + kHold_ticks;

// The factor of the force at a tick of an interval, 0 to 1: cosine ramps at both ends, 1 between them.
double interval_share(std::uint32_t tick) noexcept;
// Whether a tick of an interval is between the ramps.
constexpr bool is_held(std::uint32_t tick) noexcept { return tick >= kRamp_ticks && tick < kRamp_ticks + kHold_ticks; }

// The force of an interval: `size` in newtons, or `size` times a stroke. A stroke has one force per tick of an interval
// and outlives the presentation.
struct Stimulus {
  double size = 0.0;
  const std::vector<double>* stroke_N = nullptr;

  double force_N(std::uint32_t tick) const noexcept;  // with the ramps
};
using Stimuli = std::array<Stimulus, 3>;  // the reminder, the first and the second
// Constant stimuli have none: the first element has no stroke.
inline bool has_reminder(const Stimuli& stimuli) noexcept { return stimuli[0].stroke_N != nullptr; }

struct PresentationState {
  std::uint64_t presentation = 0;      // number of the presentation, from 1; 0: none yet
  std::uint64_t tick = 0;              // since the presenter was made
  std::uint64_t finished_at = 0;       // tick after the end of the second interval; 0: not finished
  int interval = -1;                   // that is presented now, an index of Stimuli; -1 none
  bool limited = false;                // the limiter changed a force of this presentation
  double worst_N = 0.0;                // largest |rendered - commanded force| in the intervals
  std::array<double, 3> rendered_N{};  // means between the ramps, by interval
};

class StudyPresenter {
 public:
  // Slow side. Begins a presentation at the next tick and cancels a running one. Returns its number.
  std::uint64_t present(const Stimuli& stimuli) noexcept;
  void stop() noexcept { stopped_.store(true, std::memory_order_release); }  // permanently
  const PresentationState& newest() noexcept { return states_.newest(); }

  // Haptics thread. `rendered_N`: the force that the device received for the return value of the previous tick, after
  // all other limits. Returns the force to render.
  double tick(double rendered_N) noexcept;

 private:
  struct Order {
    std::uint64_t presentation = 0;
    Stimuli stimuli;
  };
  void record(double rendered_N) noexcept;
  double next_command_N() noexcept;

  TripleBuffer<Order> orders_;
  TripleBuffer<PresentationState> states_;
  std::atomic<bool> stopped_{false};
  std::uint64_t ordered_ = 0;  // slow side

  // Haptics thread.
  ForceLimiter limiter_{ForceLimits{kLargestStudyForce_N, kFastestStudyForce_N_per_s, 0.0}};
  PresentationState state_;
  std::uint32_t played_ = 0;       // ticks since the presentation began
  std::uint32_t in_interval_ = 0;  // of the last command
  double commanded_N_ = 0.0;       // by the last tick
};

// One recorded stroke as rendered by two models, or by a model and the recorded force (prepare_strokes).
struct StrokePair {
  std::string reference;   // "recorded force" or a model's name
  std::string comparison;  // a model's name
  std::string recording;
  double from_s = 0.0;         // in the recording
  std::uint64_t checksum = 0;  // of both forces
  JndLine jnd;
  // |comparison - reference| over the JND of the reference, over the ticks in contact, with the ramps of an interval.
  double mean_over_jnd = 0.0, max_over_jnd = 0.0;
  // Means between the ramps, which represent the strokes in a study file.
  double reference_mean_N = 0.0, comparison_mean_N = 0.0;
  // One force per tick of an interval, rounded to 0.1 mN; empty when the pair was read from a study file.
  std::vector<double> reference_N, comparison_N;
};
using StrokesPointer = std::shared_ptr<const StrokePair>;

inline constexpr std::array<double, 4> kReferenceForces_N = {0.3, 0.5, 1.0, 2.5};
inline constexpr std::array<int, 8> kComparisonPercent = {60, 70, 80, 90, 110, 120, 130, 140};
inline constexpr int kRepetitions = 10;  // of each pair; even, for the balance
inline constexpr std::size_t kDiscriminationTrials = 100;
// Trials between two breaks. Of constant stimuli: two repetitions of each pair.
inline constexpr std::size_t kConstantBlock = 64;
inline constexpr std::size_t kDiscriminationBlock = 20;

struct StudyTrial {
  double reference_N = 0.0, comparison_N = 0.0;
  bool comparison_first = false, training = false;
  std::size_t number = 0;  // from 1, separately for the training and the study

  double first_N() const noexcept { return comparison_first ? comparison_N : reference_N; }
  double second_N() const noexcept { return comparison_first ? reference_N : comparison_N; }
  bool operator==(const StudyTrial&) const = default;
};

// `percent` % of a reference force, N, rounded to 0.1 mN as in the study file.
double percent_of(double reference_N, double percent) noexcept;

// Subjects are anonymous: a code has one to three capital letters and one to four digits, such as S01. Errors: another
// form.
Status check_subject_code(const std::string& code);

// The following functions are for constant stimuli if `strokes` is null.
// The trials of a subject, first the training: easy trials, to learn the task. With `strokes` the forces of a trial are
// the means of the strokes, and the training compares the reference with half of it.
std::vector<StudyTrial> plan_study(const std::string& code, const StrokePair* strokes);
// The forces of a trial; they refer to `strokes`.
Stimuli stimuli_of(const StudyTrial& trial, const StrokePair* strokes);

struct StudyHeader {
  std::string subject;
  StrokesPointer strokes = nullptr;  // null: constant stimuli
  // The device of new answers, and whether it renders force. Both are stored with each answer, because a study may be
  // resumed with another device.
  std::string device = "unknown";
  bool rendered = true;
};

struct StudyRecord {
  StudyTrial trial;
  double first_rendered_N = 0.0;  // mean between the ramps; forces are rounded to 0.1 mN
  double second_rendered_N = 0.0;
  bool limited = false;
  bool answered_second = false;      // "the second was larger", or "the second was like the reminder"
  std::uint32_t response_ms = 0;     // from the end of the second force
  double reminder_rendered_N = 0.0;  // this and worst_N: with strokes only
  double worst_N = 0.0;              // largest |rendered - commanded force| at any tick
  std::string device = "unknown";
  bool rendered = true;  // false: a rehearsal on a device without force

  bool comparison_judged_larger() const noexcept { return answered_second != trial.comparison_first; }
  bool found_larger() const noexcept { return answered_second == (trial.second_N() > trial.first_N()); }
  bool found_reference() const noexcept { return answered_second == trial.comparison_first; }
  double reference_rendered_N() const noexcept { return trial.comparison_first ? second_rendered_N : first_rendered_N; }
  // The rendered difference relative to the rendered reference.
  double rendered_difference() const noexcept;
  bool operator==(const StudyRecord&) const = default;
};

struct StudyData {
  StudyHeader header;
  std::vector<StudyRecord> records;
};

// Errors: the first place where the text is not in this format, or not of the subject's plan, as "path:line:column:
// found ..., expected ...".
Result<StudyData> parse_study(const std::string& text, const std::string& path);
// Errors: the file is not readable; those of parse_study.
Result<StudyData> read_study(const std::string& path);
// The lines above the rows. One row with its line end; `strokes`: with the two columns of that procedure.
std::string study_header_text(const StudyHeader& header, const std::string& consent);
std::string study_row(const StudyRecord& record, bool strokes);

// Whether the files can be analysed together. Errors: two files of one subject; files of different procedures or
// strokes.
Status check_study_files(const std::vector<StudyData>& files);

class StudyFile {
 public:
  // Resumes `path` if it exists; else `consent` creates it. Errors: an invalid subject code; the file is not a study
  // file, or of another subject, procedure or strokes; it is not readable.
  static Result<StudyFile> open(const std::string& path, const StudyHeader& header);

  const StudyHeader& header() const noexcept { return header_; }
  // Whether the subject has consented, now or in an earlier session.
  bool consented() const noexcept { return !text_.empty(); }
  // Answers of earlier sessions and of this one, in order.
  const std::vector<StudyRecord>& records() const noexcept { return records_; }

  // Creates the file. `when`: any text without a line break. Errors: it could not be written; another session has
  // changed it.
  Status consent(const std::string& when);
  // Stores an answer on the disk, with the device of the header. Errors: as consent; the call may be repeated.
  Status append(StudyRecord record);

 private:
  StudyFile(const std::string& path, const StudyHeader& header) : path_(path), header_(header) {}
  Status replace(const std::string& text);

  std::string path_;
  StudyHeader header_;
  std::string text_;  // of the file; empty: there is none
  std::vector<StudyRecord> records_;
};

// Makes the pair of strokes for a discrimination study from a recording and one or two models.
// Every row of the recording goes through the tick of the live loop (engine/tick/haptics_tick.h). The forces of models
// and sensor are resampled to 1 kHz and filtered with the same zero-phase low-pass, a Hann window of 21 ms (half the
// amplitude at 45 Hz), because the noise of the sensor would make its stroke recognisable. A piece has the length of an
// interval and begins at a multiple of 100 ms. The piece with the largest sum of error / JND is
// chosen among those up to 3.8 N and 90 N/s (below the presenter's limits) and 2.5 N RMS (the heat of a small motor).
// The force over time is rendered to a still hand. The hand does not influence it, so this tests the discrimination
// of forces, as the JND study does.
// `scene`: name of a scene. `models`: methods, fitted as by `palpate fit`, or model files. Two: the reference and the
// comparison. One: the comparison; the recorded force is the reference. None: as one, the first default model of the
// scene. `recording`: the file to render, to which no model was fitted; empty: a recording of the scene's virtual
// material with seed 2.
// Errors: more than two models; those of load_scene, of requested_models, of the fits and of the recording; neither
// recording nor virtual material; no piece within the limits.
Result<StrokesPointer> prepare_strokes(const std::string& scene, const std::vector<std::string>& models,
                                       const std::string& recording);

// The same for ready models; `reference` null: the recorded force.
Result<StrokesPointer> strokes_of(const Recording& recording, const std::shared_ptr<const ForceModel>& reference,
                                  const std::shared_ptr<const ForceModel>& comparison, const JndLine& jnd);

}  // namespace palpate
