// Somebody who answers as a psychometric function says, to try the study on.
//
// A force F is felt as F + s(F) n, n normal with variance 1, and the second of two
// as a bias more; the larger is what feels larger. s is such that the JND at the
// criterion 0.75 is the line JND(F) = offset + weber_fraction F when both forces are
// felt alike: s(F) = JND(F) / (0.6745 sqrt(2)). Sometimes the subject misses a trial
// and guesses.
//
// Two strokes it tells apart at the moment at which what it was given differs most, in
// multiples of its JND: it feels both there, as above, and has learned from the
// reminder which of the two is the larger there. So it is right with the probability
//   Phi(|F1 - F2| / sqrt(s(F1)^2 + s(F2)^2)),
// 75 % for one JND; nobody with this noise who attends to one moment does better.
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
  double order_bias_jnd = 0.0;  // added to the second force, multiples of the JND
  double lapse_rate = 0.0;      // 0 .. 0.5: missed trials are 2 x this, half of them wrong
};

class SimulatedSubject {
 public:
  SimulatedSubject(const SubjectTraits& traits, std::uint64_t seed) noexcept
      : traits_(traits), random_(seed, kStream) {}

  bool second_feels_larger(double first_N, double second_N) noexcept;
  // Of two forces the second was the larger, of two strokes it was like the reminder.
  bool answers_second(const Stimuli& stimuli) noexcept;

 private:
  static constexpr std::uint64_t kStream = 31;
  SubjectTraits traits_;
  RandomStream random_;
};

// All answers of one subject, training included, to forces that were rendered as planned.
std::vector<StudyRecord> simulated_answers(const StudyHeader& header, const SubjectTraits& traits, std::uint64_t seed);

}  // namespace palpate
