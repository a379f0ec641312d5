// Estimates the psychometric functions and JNDs of a subject from the answers.
// With x = (comparison - reference) / reference and o = +1 when the comparison came second, -1 when it came first, the
// comparison is judged the larger with probability
//   P(x, o) = lapse + (1 - 2 lapse) Phi(slope x + order_bias o),
// a cumulative Gaussian with a lapse rate (Wichmann & Hill 2001, Perception & Psychophysics 63(8), 1293-1313). Each
// reference force has its own slope. The lapse rate and the order bias, which favours the second force, are the same
// for all reference forces of a subject. There is no other shift, because a subject cannot know which of two forces is
// the reference. (A shift and a lapse rate for each reference force, fitted to 80 answers each, made the JND 10 % too
// small and doubled its error.)
// The JND at a criterion c is half the distance between the comparisons that are judged larger with probability c and
// 1 - c, without lapses and order bias:
//   JND = Phi^-1(c) reference / slope.
// c = 0.75 gives half the interquartile distance; the paper does not state its criterion.
// Thread guarantee: pure functions; slow side (they allocate).
#pragma once

#include <cstddef>
#include <vector>

namespace palpate {

inline constexpr double kJndCriterion = 0.75;
inline constexpr double kCriterionQuantile = 0.6744897501960817;  // Phi^-1(kJndCriterion)

// Phi.
double normal_cdf(double z) noexcept;

// The answers to all trials with the same stimuli. Counts may be fractional, for expected answers.
struct AnswerCell {
  std::size_t reference = 0;  // index of the reference force
  double difference = 0.0;    // x
  bool comparison_first = false;
  double judged_larger = 0.0;  // number of trials in which the comparison was judged the larger
  double trials = 0.0;
};

struct PsychometricFunction {
  double slope = 1.0;  // 0.25 .. 40, a JND of 2.7 times the reference to one of 1.7 %
  double order_bias = 0.0;
  double lapse = 0.0;  // 0 .. 0.06
  // Whether the answers bound the slope on both sides. They do not when all are correct or all are guesses; the slope
  // is then at or near an end of its range.
  bool determined = false;

  double at(double difference, bool comparison_first) const noexcept;
  // The JND over the reference, at kJndCriterion.
  double jnd() const noexcept { return kCriterionQuantile / slope; }
};

// The functions of `references` reference forces by joint maximum likelihood. The lapse rate is a multiple of 0.01.
std::vector<PsychometricFunction> fit_psychometric(const std::vector<AnswerCell>& cells, std::size_t references);

}  // namespace palpate
