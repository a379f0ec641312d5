// Cross-validated errors of candidates and the one rule that selects among them.
//
// Each candidate predicts the samples of every fold (fold_assignment.h) from the other folds. The score of a fold is
//   l_k = ln(mean_i (e_i / JND_i)^2 + kUnnoticed_jnd^2).
// The logarithm keeps a fold that is difficult for every candidate from dominating; the constant makes errors below
// the JND irrelevant. The rule takes the simplest candidate whose mean score exceeds the best by at most two standard
// errors of the paired difference, which is then not significant at the 95 % level. (With one standard error the
// share within the JND falls by up to 1.4 points: tests/bench/README.md.)
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

  // Adds a sample with an error in JND to a fold.
  void add(std::size_t fold, double error_over_jnd) {
    squares[fold] += error_over_jnd * error_over_jnd;
    counts[fold] += 1.0;
  }
  // Root mean square over all samples, in JND.
  double rms() const;
  // sqrt(exp(mean score) - kUnnoticed_jnd^2), in JND: the RMS error of a fold whose score is the mean score.
  double rms_at_mean_score() const;

  std::vector<double> squares;  // by fold, in JND^2
  std::vector<double> counts;   // samples
};

// Index of the candidate with the lowest mean score.
std::size_t best_score(std::span<const FoldErrors> candidates);

// Index of the selected candidate. `candidates`: at least one, from the simplest to the most complex, same folds.
std::size_t simplest_adequate(std::span<const FoldErrors> candidates);

}  // namespace palpate
