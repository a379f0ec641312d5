// The errors of candidates in cross-validation, and the rules that choose among them.
// Every candidate predicts the samples of each fold (samples.h) from the other folds. The score of a fold is
//   l_k = ln(mean_i (e_i / JND_i)^2 + kUnnoticed_jnd^2):
// the logarithm keeps a fold that is difficult for every candidate from dominating; the constant makes errors below the
// JND irrelevant. The correction and what the paper leaves open have the lowest score. The shape of the trend is the
// simplest whose mean score exceeds the lowest by at most two standard errors of the paired difference; with the lowest
// score for its smoothness, the share within the JND of the recorded sets falls by 0.8 points (tests/bench/README.md).
// Source: Breiman et al. (1984), section 3.4.3; Hastie, Tibshirani & Friedman (2009), section 7.10.
// Thread guarantee: value types and pure functions, slow side.
#pragma once

#include <cmath>
#include <span>
#include <vector>

namespace palpate {

// The factor robust_scale is the square root of the weight of a Cauchy likelihood (Holland & Welsch 1977): 1 for small
// errors, less for errors well above the JND, which would otherwise bend the fit elsewhere.
inline constexpr double kRobustError_jnd = 2.0;

inline double robust_scale(double error_over_jnd) noexcept {
  const double share = error_over_jnd / kRobustError_jnd;
  return 1.0 / std::sqrt(1.0 + share * share);
}

// By fold, the greatest depth in the other folds. Deeper samples of the fold would be extrapolated, so they do not
// count. `fold`, `depth_m`: of each sample.
std::vector<double> deepest_elsewhere_m(std::span<const int> fold, std::span<const double> depth_m, int folds);

// With this RMS, in JND, one of 16,000 normally distributed errors exceeds the JND.
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

// The `errors` of candidates.
template <typename Candidate>
std::vector<FoldErrors> errors_of(const std::vector<Candidate>& candidates) {
  std::vector<FoldErrors> errors;
  for (const Candidate& one : candidates) errors.push_back(one.errors);
  return errors;
}

// Index of the candidate with the lowest mean score.
std::size_t best_score(std::span<const FoldErrors> candidates);
// Index of the selected candidate. `candidates`: at least one, from the simplest to the most complex, with the same
// folds. A fold in which one of them has no samples is ignored.
std::size_t simplest_adequate(std::span<const FoldErrors> candidates);

}  // namespace palpate
