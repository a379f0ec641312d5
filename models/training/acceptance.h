// How the fit tells whether one candidate is better than another.
//
// Candidates predict the same samples of the same folds (fold_dealer.h) without having
// seen them. A further part of the trend is accepted where it lowers the sum of squared
// errors by more than two standard errors of the differences between the folds,
//   sum_k (a_k - b_k) > 2 s,  s^2 = n / (n - 1) sum_k (a_k - b_k - mean)^2,
// 95 % if they are normal; paired, since what makes a fold hard is the same for both.
// Settings of one candidate are as good as the best within one standard error (Breiman
// et al. 1984, section 3.4.3; Hastie, Tibshirani & Friedman 2009, section 7.10).
//
// What differs in kind, a trend and a corrected one, a place and another, differs much in
// some blocks and little in others, and a sum with its spread then tells nothing: a
// correction that took 89 to 99 % of the error from every fold was not accepted, because one fold
// had most of it. There every block has one voice, its share r_k = (a_k - b_k) /
// (a_k + b_k), and a is certainly worse where mean r > 2 s / sqrt(n).
// Thread guarantee: pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace palpate {

// How much less the folds of `b` sum to than those of `a`, and the standard error of that;
// 0 with one fold.
struct PairedGain {
  double sum = 0.0;
  double standard_error = 0.0;
};
inline PairedGain paired_gain(const std::vector<double>& a, const std::vector<double>& b) {
  PairedGain gain{std::accumulate(a.begin(), a.end(), 0.0) - std::accumulate(b.begin(), b.end(), 0.0), 0.0};
  const auto folds = static_cast<double>(a.size());
  if (folds < 2.0) return gain;
  double squares = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double rest = a[k] - b[k] - gain.sum / folds;
    squares += rest * rest;
  }
  gain.standard_error = std::sqrt(squares * folds / (folds - 1.0));
  return gain;
}

// Whether the errors `other`, by fold, earn their candidate the place of the simpler one.
inline bool is_worth_it(const std::vector<double>& other, const std::vector<double>& simpler) {
  const PairedGain gain = paired_gain(simpler, other);
  return gain.sum > 2.0 * gain.standard_error;
}

// Whether a setting with the errors `one` is as good as the best.
inline bool is_as_good(const std::vector<double>& one, const std::vector<double>& best) {
  const PairedGain gain = paired_gain(one, best);
  return gain.sum <= gain.standard_error;
}

// Whether `one` is worse than the best, block by block. Differences below a tenth of a mean
// block are noise.
inline bool is_certainly_worse(const std::vector<double>& one, const std::vector<double>& best) {
  constexpr double kLeastBlock = 0.1;
  const auto count = static_cast<double>(one.size());
  const double least = kLeastBlock * std::accumulate(best.begin(), best.end(), 0.0) / count;
  double mean = 0.0;
  double squares = 0.0;
  for (std::size_t b = 0; b < one.size(); ++b) {
    const double whole = one[b] + best[b] + least;
    const double share = whole > 0.0 ? (one[b] - best[b]) / whole : 0.0;
    mean += share / count;
    squares += share * share;
  }
  const double variance = std::max(0.0, squares / count - mean * mean) / std::max(1.0, count - 1.0);
  return mean > 2.0 * std::sqrt(variance);
}

}  // namespace palpate
