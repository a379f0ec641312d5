// Paired comparison of the costs of two candidate offsets (models/recordings/profile_search.h).
//
// Both candidates, a and b, have costs a_k and b_k over the same n blocks of samples. Block k gives the relative
// difference r_k = (a_k - b_k) / (a_k + b_k + m / 10), where m is the mean of the b_k. Candidate a is significantly
// worse if mean r > 2 s / sqrt(n), s the standard deviation of r: a paired t-test at two standard errors.
// Thread guarantee: pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace palpate {

// Whether the sum of `one` exceeds the sum of `best` by at most one standard error of their paired differences.
inline bool is_within_one_standard_error(const std::vector<double>& one, const std::vector<double>& best) {
  const auto count = static_cast<double>(one.size());
  const double sum = std::accumulate(one.begin(), one.end(), 0.0) - std::accumulate(best.begin(), best.end(), 0.0);
  if (count < 2.0) return sum <= 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) squares += std::pow(one[k] - best[k] - sum / count, 2);
  return sum <= std::sqrt(squares * count / (count - 1.0));
}

// Whether `one` is significantly worse than `best` by the test above. The tenth of the mean block damps blocks with
// small costs, whose relative differences are noise.
inline bool is_significantly_worse(const std::vector<double>& one, const std::vector<double>& best) {
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
