// A simulated subject that answers by a psychometric function, to test the study.
// A force F is perceived as F + s(F) n with n normal of variance 1; a bias is added to the second of two forces. The
// subject answers with the larger perceived force. s(F) = JND(F) / (0.6745 sqrt(2)), so that the JND at the criterion
// 0.75 is JND(F) = offset + weber_fraction F. In a share of the trials the subject guesses.
// Two strokes are compared at the tick at which they differ most in multiples of the JND. The subject perceives both
// forces there, as above, and knows from the reminder which is the larger. It is correct with the probability
//   Phi(|F1 - F2| / sqrt(s(F1)^2 + s(F2)^2)),
// 75 % for one JND, the optimum for an observer with this noise who attends to one tick.
// Deterministic: the same seed gives the same answers.
// Thread guarantee: one thread; slow side.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/tick/jnd.h"
#include "scenes/study/study_store.h"

namespace palpate {

struct SubjectTraits {
  JndLine jnd;
  double order_bias_jnd = 0.0;  // added to the second force, in multiples of the JND
  double lapse_rate = 0.0;      // 0 .. 0.5; the subject guesses in a share of 2 x this, half of it wrong
};

class SimulatedSubject {
 public:
  SimulatedSubject(const SubjectTraits& traits, std::uint64_t seed) noexcept
      : traits_(traits), random_(seed, kStream) {}

  bool second_feels_larger(double first_N, double second_N) noexcept;
  // Whether the answer is "second": the larger of two forces, or the stroke that equals the reminder.
  bool answers_second(const Stimuli& stimuli) noexcept;

 private:
  static constexpr std::uint64_t kStream = 31;
  SubjectTraits traits_;
  RandomStream random_;
};

// All answers of one subject, including training, to forces that are rendered exactly as planned.
std::vector<StudyRecord> simulated_answers(const StudyHeader& header, const SubjectTraits& traits, std::uint64_t seed);

}  // namespace palpate
