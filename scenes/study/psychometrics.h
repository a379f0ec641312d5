// From answers to thresholds: the psychometric function and its JND.
//
// With x = (comparison - reference) / reference and o = +1 when the comparison
// came second, -1 when it came first, the comparison is judged the larger with
//   P(x, o) = lapse + (1 - 2 lapse) Phi(intercept + slope x + order_bias o)
// a cumulative Gaussian with mean -intercept / slope (the point of subjective
// equality), standard deviation 1 / slope, a lapse rate, and what a subject adds
// to whatever comes second (Wichmann & Hill 2001, Perception & Psychophysics
// 63(8), 1293-1313; the order term is ours: an order bias that the fit does not
// know would be taken for a flat slope).
//
// The JND at a criterion c is half the distance between the comparisons that are
// judged larger with probability c and 1 - c, lapses aside:
//   JND = Phi^-1(c) reference / slope.
// c = 0.75, half the interquartile distance, is the default; the paper does not
// state its own.
// Thread guarantee: pure functions; slow side (they allocate).
#pragma once

#include <cstddef>
#include <vector>

#include "engine/random_stream.h"

namespace palpate {

inline constexpr double kJndCriterion = 0.75;

// Phi and its inverse; `probability` above 0 and below 1.
double normal_cdf(double z) noexcept;
double normal_quantile(double probability) noexcept;

// Answers to one kind of trial. Counts need not be whole: expected answers are
// answers too.
struct AnswerCell {
  double difference = 0.0;  // x
  bool comparison_first = false;
  double judged_larger = 0.0;  // how often the comparison was
  double trials = 0.0;
};

// Adds one answer to its cell, which is made when there is none yet.
void add_answer(std::vector<AnswerCell>& cells, double difference, bool comparison_first, bool judged_larger);

struct PsychometricFunction {
  double intercept = 0.0;
  double slope = 1.0;  // > 0
  double order_bias = 0.0;
  double lapse = 0.0;  // 0 .. 0.06

  double at(double difference, bool comparison_first) const noexcept;
  // Relative to the reference.
  double jnd(double criterion) const noexcept { return normal_quantile(criterion) / slope; }
};

struct PsychometricFit {
  PsychometricFunction function;
  double log_likelihood = 0.0;
  // False when the answers do not bound the slope: all right or mere guesses. The
  // slope is then the end of its range, 0.25 .. 40.
  bool determined = true;
};

// Maximum likelihood; the lapse rate to 0.01, at most 0.06. No answers: not
// determined.
PsychometricFit fit_psychometric(const std::vector<AnswerCell>& cells);

// A value and the interval that holds the truth at the stated rate.
struct Estimate {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  bool determined = true;
};

struct BootstrapSettings {
  double criterion = kJndCriterion;
  double level = 0.95;
  int resamples = 999;
};

// The relative JND with a confidence interval by the parametric bootstrap (Wichmann
// & Hill 2001, Perception & Psychophysics 63(8), 1314-1329): answers are drawn from
// the fitted function at the same stimuli and fitted again. The percentiles are
// bias-corrected (Efron 1987). Counts must be whole.
Estimate bootstrap_jnd(const std::vector<AnswerCell>& cells, const PsychometricFit& fit,
                       const BootstrapSettings& settings, RandomStream random);

// Bias-corrected percentiles of `replicates` (at least one, any order) around
// `value`.
Estimate bias_corrected_interval(double value, std::vector<double> replicates, double level);

}  // namespace palpate
