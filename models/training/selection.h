// Cross-validated errors of candidates and the one rule that selects among them.
//
// Candidates predict the samples of every fold (fold_dealer.h) from the other folds. The score of
// a fold is the logarithm of its mean squared error over the JND,
//   l_k = ln(mean_i (e_i / JND_i)^2 + kUnnoticed_jnd^2),
// so that a fold that is hard for every candidate does not outvote the others, and errors
// that a hand cannot notice do not count. The simplest candidate is taken whose mean score exceeds that
// of the best by at most two standard errors of their paired differences: the difference is not
// significant at the 95 % level. It is the one-standard-error rule at that level; with one
// standard error recorded sets lose up to two points (tests/bench/README.md).
// Source: Breiman, Friedman, Olshen & Stone (1984), section 3.4.3; Hastie, Tibshirani & Friedman
// (2009), section 7.10.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate {

// With normal errors of a quarter of a JND (RMS) one sample in 16,000 exceeds the JND.
inline constexpr double kUnnoticed_jnd = 0.25;

struct FoldErrors {
  FoldErrors(std::size_t folds = 0) : squares(folds, 0.0), counts(folds, 0.0) {}

  // An error of so many JND in a fold.
  void add(std::size_t fold, double error_over_jnd) {
    squares[fold] += error_over_jnd * error_over_jnd;
    counts[fold] += 1.0;
  }
  // Over all samples, in JND.
  double rms() const;
  // What the rule compares, in JND: the error (RMS) of a fold whose score is the mean score.
  double typical() const;

  std::vector<double> squares;  // by fold, in JND^2
  std::vector<double> counts;   // samples
};

// Index of the candidate with the lowest mean score.
std::size_t best_score(std::span<const FoldErrors> candidates);

// Index of the selected one of `candidates`, which stand from the simplest to the most complex and
// have the same folds. At least one.
std::size_t simplest_adequate(std::span<const FoldErrors> candidates);

}  // namespace palpate
