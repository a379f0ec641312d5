// What a subject is given to compare, and in which order: constant stimuli, or two
// strokes to tell apart. All of it is known before the first answer.
//
// Constant stimuli: two-alternative forced choice without movement: a reference force and a
// comparison force one after the other, "which was larger?". Method of constant
// stimuli as in Hoever & Harders (2009), section 4.1: reference forces 0.3, 0.5,
// 1.0 and 2.5 N, comparison forces from 60 % to 140 % of the reference in eight
// steps (100 % is none: there is nothing to tell apart), each pair ten times: 320
// trials. The order is drawn anew for each subject, and balanced: each pair comes
// once in every 32 trials, five times with the comparison first and five times
// second.
//
// Two strokes: two-alternative forced choice with a reminder (M. J. Hautus, N. A.
// Macmillan & C. D. Creelman 2022, Detection Theory: A User's Guide, 3rd ed., chapter
// 7: "2AFCR"; the design of the duo-trio test with constant reference, ISO 10399): the
// reference stroke, then reference and comparison in either order; which of the two was
// like the first? Who uses the difference does as well as in 2AFC without a reminder, so
// that d' = sqrt(2) Phi^-1(share correct) and one JND (criterion 0.75) is 75 % correct:
// what the JND says can be held against it. A reminder is needed because strokes differ
// in any way, not only in size. No feedback after the training.
// Deterministic: the subject code alone decides.
// Thread guarantee: values and pure functions; slow side (they allocate).
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/study/stroke_pair.h"
#include "scenes/study/study_presenter.h"

namespace palpate {

inline constexpr std::array<double, 4> kReferenceForces_N = {0.3, 0.5, 1.0, 2.5};
inline constexpr std::array<int, 8> kComparisonPercent = {60, 70, 80, 90, 110, 120, 130, 140};
inline constexpr int kRepetitions = 10;  // of each pair; even, for the balance

struct StudyTrial {
  double reference_N = 0.0;
  double comparison_N = 0.0;
  bool comparison_first = false;

  double first_N() const noexcept { return comparison_first ? comparison_N : reference_N; }
  double second_N() const noexcept { return comparison_first ? reference_N : comparison_N; }
  bool operator==(const StudyTrial&) const = default;
};

// A comparison force to 0.1 mN, so that it is written as it is.
double percent_of(double reference_N, double percent) noexcept;

// A subject is known by a code, never by a name: one to three capital letters
// and one to four digits, such as S01. Errors: anything else.
Status check_subject_code(const std::string& code);

// How many trials with two strokes, and how many of them between two breaks; in each such
// block the comparison comes first as often as second.
inline constexpr std::size_t kDiscriminationTrials = 100;
inline constexpr std::size_t kDiscriminationBlock = 20;

struct StudyPlan {
  const StrokePair* strokes = nullptr;  // null: constant stimuli
  std::vector<StudyTrial> training;     // easy ones, to learn the task
  std::vector<StudyTrial> trials;
  std::size_t trials_per_block = 64;  // between two breaks: two repetitions of each pair

  // What is presented in a trial, of the training or not.
  Stimuli stimuli(const StudyTrial& trial, bool in_training) const;
};
// The trials of a subject; those with strokes, which outlive the plan, have the means of
// their forces, and in the training the reference against half of it.
StudyPlan plan_study(const std::string& code, const StrokePair* strokes);

}  // namespace palpate
