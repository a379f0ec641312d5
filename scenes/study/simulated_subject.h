// A simulated subject that answers by a psychometric function, to test the study.
// A force F is perceived as F + s(F) n with n normal of variance 1; a bias is added to the second of two forces. The
// subject answers with the larger perceived force. s(F) = JND(F) / (0.6745 sqrt(2)), so that the JND at the criterion
// 0.75 is JND(F) = offset + weber_fraction F. In a share of the trials the subject guesses.
// Two strokes are compared at the tick at which they differ most in multiples of the JND. The subject perceives both
// forces there, as above, and knows from the reminder which stroke has the larger. It is correct with the probability
//   Phi(|F1 - F2| / sqrt(s(F1)^2 + s(F2)^2)),
// 75 % for one JND, the optimum for an observer with this noise who attends to one tick.
// Deterministic: the same seed gives the same answers.
// Thread guarantee: one thread; slow side.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/tick/jnd.h"
#include "scenes/study/study_file.h"

namespace palpate {

struct SubjectTraits {
  JndLine jnd;
  double order_bias_jnd = 0.0;  // added to the second force, in multiples of the JND
  double lapse_rate = 0.0;      // 0 .. 0.5; the subject guesses in a share of 2 x this, half of it wrong
};

// A subject with the paper's JND at 2.5 N, 13.3 %.
inline constexpr SubjectTraits kSubjectOf2009{{0.05, 0.113}, 0.0, 0.01};

// Whether the second of two forces is perceived as the larger. Draws the same number of random numbers for every trial,
// so that an answer does not change later trials.
bool second_feels_larger(const SubjectTraits& traits, double first_N, double second_N, RandomStream& random) noexcept;

// All answers of one subject, including training, to forces that are rendered exactly as planned.
std::vector<StudyRecord> simulated_answers(const StudyHeader& header, const SubjectTraits& traits, std::uint64_t seed);

}  // namespace palpate
