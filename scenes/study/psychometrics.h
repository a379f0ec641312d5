// From answers to thresholds: the psychometric functions of a subject and their JNDs.
//
// With x = (comparison - reference) / reference and o = +1 when the comparison came
// second, -1 when it came first, the comparison is judged the larger with
//   P(x, o) = lapse + (1 - 2 lapse) Phi(slope x + order_bias o)
// a cumulative Gaussian with a lapse rate (Wichmann & Hill 2001, Perception &
// Psychophysics 63(8), 1293-1313). Each reference force has its slope; the lapse rate
// and what is added to whatever comes second, in multiples of the noise, belong to the
// subject and are the same for all. There is no other shift: which of two forces is
// "the reference" is nothing that a subject could know. (Four shifts and lapse rates
// more, fitted to 80 answers each, made the JND 10 % too small and doubled its error.)
//
// The JND at a criterion c is half the distance between the comparisons that are
// judged larger with probability c and 1 - c, lapses and order aside:
//   JND = Phi^-1(c) reference / slope.
// c = 0.75, half the interquartile distance; the paper does not state its own.
// Thread guarantee: pure functions; slow side (they allocate).
#pragma once

#include <cstddef>
#include <vector>

namespace palpate {

inline constexpr double kJndCriterion = 0.75;

// Phi and its inverse; `probability` above 0 and below 1.
double normal_cdf(double z) noexcept;
double normal_quantile(double probability) noexcept;

// Answers to one kind of trial. Counts need not be whole: expected answers are
// answers too.
struct AnswerCell {
  std::size_t reference = 0;  // which reference force, from 0; at most kMostReferences
  double difference = 0.0;    // x
  bool comparison_first = false;
  double judged_larger = 0.0;  // how often the comparison was
  double trials = 0.0;
};
inline constexpr std::size_t kMostReferences = 8;

// Adds answers to the cell of their kind, which is made when there is none yet.
void add_answers(std::vector<AnswerCell>& cells, const AnswerCell& answers);

struct PsychometricFunction {
  double slope = 1.0;  // > 0
  double order_bias = 0.0;
  double lapse = 0.0;  // 0 .. 0.06

  double at(double difference, bool comparison_first) const noexcept;
  // Relative to the reference, at kJndCriterion.
  double jnd() const noexcept { return normal_quantile(kJndCriterion) / slope; }
};

struct PsychometricFit {
  std::vector<PsychometricFunction> functions;  // of each reference force
  // Whether the answers bound the slope on both sides: not when they are all right, or
  // mere guesses. The slope is then an end of its range, 0.25 .. 40, or anywhere near.
  std::vector<bool> determined;
};

// Maximum likelihood for `references` reference forces (1 .. kMostReferences) together;
// the lapse rate to 0.01, at most 0.06.
PsychometricFit fit_psychometric(const std::vector<AnswerCell>& cells, std::size_t references);

}  // namespace palpate
