// The choice among candidates by their errors, in cross-validation (models/METHOD.md, Score) and over offsets.
//
// Offsets. `estimate_offset` searches the offset (of a surface, a force lag, ...) with the lowest cost, gives its
// standard error, and tests whether the data identify it. The cost is a sum over blocks, pieces of the recordings with
// independent errors.
// 1. Search: a scan of the range, and golden sections at its lowest minima.
// 2. Standard error, by the jackknife (Quenouille 1956; Tukey 1958): the search without block b gives x_b, and the
//    error is sqrt((n - 1)/n sum_b (x_b - mean)^2).
// 3. Identified: two standard errors stay within the range and below `widest`, and every other minimum is significantly
//    worse. An identified offset within two standard errors of 0 is 0.
//
// Significantly worse: a paired t-test at two standard errors of r_k = (a_k - b_k) / (a_k + b_k + m / 10), the costs of
// both offsets in block k, m the mean of the b_k. An effect of the material, the same in all blocks, may look like an
// offset. Where its size is known (`systematic_effect`), the costs at 0 and at this distance on either side must be
// significantly worse, and the offset must exceed the effect plus two standard errors.
// Thread guarantee: value types and pure functions, slow side.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
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

// The standard error of a quantity that a recording does not identify.
inline constexpr double kUnknownError = std::numeric_limits<double>::infinity();
// An offset is significant at this many standard errors from 0.
inline constexpr double kSignificantErrors = 2.0;
// Smaller offsets count as 0: the position estimate of one touch is no finer.
inline constexpr double kLeastOffset_m = 0.02e-3;
// A surface with a larger error (two standard errors) is not identified: in soft materials, whose force rises by
// 0.1 N/mm at first, it is one JND.
inline constexpr double kWidestSurface_m = 0.5e-3;

// The resolution of all searches.
inline constexpr double kFinest_m = 2e-6;

// Huber's loss (1964): the square of the error up to `limit`, linear beyond.
inline double huber(double error, double limit) {
  const double size = std::abs(error);
  return size <= limit ? size * size : limit * (2.0 * size - limit);
}

using BlockCosts = std::vector<double>;
// The cost J, by blocks, of an offset.
using CostFunction = std::function<BlockCosts(double)>;

struct OffsetEstimate {
  double at = 0.0;                        // the offset; 0 if not identified or not significantly different from 0
  bool not_zero = false;                  // the minimum differs from 0 significantly
  double standard_error = kUnknownError;  // infinite if not identified
  bool identified = false;
  double minimum_at = 0.0;  // the minimum, identified or not, and its costs
  BlockCosts minimum{};
  // N: a force offset that explains the data as well or better, so that `at` is not identified; 0: there is none.
  double force_offset_N = 0.0;
  bool force_offset_better = false;  // it explains them significantly better
};

struct SearchRange {
  double low = 0.0, high = 0.0, coarse_step = 0.0, fine_step = 0.0;
  double widest = 0.0;             // limit of two standard errors
  double systematic_effect = 0.0;  // of the material, in units of the offset; 0: none
};

// The minimum of `cost` in `range`, which contains 0. Not identified where the range is empty.
OffsetEstimate estimate_offset(const CostFunction& cost, const SearchRange& range);
// Tests whether a force offset explains the data as well as `shift`: whether the lowest cost over force offsets of
// -most_N to most_N exceeds that of the shift by at most one standard error of their paired differences. If so, the
// shift is not identified. `cost`: J by blocks for a force offset in N.
OffsetEstimate unless_force_offset(OffsetEstimate shift, const CostFunction& cost, double most_N);

}  // namespace palpate
