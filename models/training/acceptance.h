// Whether one candidate offset is significantly worse than another (models/surface/profile_search.h).
//
// Candidates have the same blocks of samples. A block has one vote, its relative difference
// r_k = (a_k - b_k) / (a_k + b_k + m / 10) with m the mean of the b, and a is significantly worse where mean r > 2 s /
// sqrt(n): a paired t-test at two standard errors.
//
// Thread guarantee: pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace palpate {

// Whether the blocks of `one` sum to no more than those of the best by one standard error of their
// paired differences.
inline bool is_as_good(const std::vector<double>& one, const std::vector<double>& best) {
  const auto count = static_cast<double>(one.size());
  const double sum = std::accumulate(one.begin(), one.end(), 0.0) - std::accumulate(best.begin(), best.end(), 0.0);
  if (count < 2.0) return sum <= 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) squares += std::pow(one[k] - best[k] - sum / count, 2);
  return sum <= std::sqrt(squares * count / (count - 1.0));
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
