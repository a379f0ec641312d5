// The trials of a subject and their order, which depend on the subject code only.
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
// Thread guarantee: values and pure functions; slow side (they allocate).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/study/study_presenter.h"

namespace palpate {

// One recorded stroke as rendered by two models, or by a model and the recorded force (prepare_strokes.h).
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

}  // namespace palpate
