// Recommends one of several models that were evaluated on the same samples.
//   best         the model with the lowest 99 % error
//   near_best    models whose 99 % error exceeds the lowest by at most kMargin_jnd
//   recommended  of these the one with the lowest median time of a tick; where others take at most kEqualTime longer,
//                the simplest of them: trend, greedy, kD-tree, random, voxel, direct
// The estimates alone decide, so that the result does not depend on the width of an interval. The report, the main job
// and the window use this rule.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

// One JND is the difference at which 75 % of forced choices between two forces are correct: z(0.75) = 0.674 standard
// deviations of the psychometric function. At a quarter of it Phi(0.25 x 0.674) = 57 % are correct; chance is 50 %.
inline constexpr double kMargin_jnd = 0.25;
// Medians of six rounds of the same model differ by a few percent.
inline constexpr double kEqualTime = 0.1;

struct Candidate {
  std::string method;  // "greedy", "trend+greedy"
  double p99_error_over_jnd = 0.0;
  double tick_ns = 0.0;  // median
};

struct Ranking {
  std::size_t best = 0;
  std::size_t recommended = 0;
  std::vector<bool> near_best;  // for each candidate
};

// `candidates`: at least one, each with samples. `best` and `recommended` are indices of `candidates`; with equal
// errors or equally simple methods the first, and the one with the lower error.
Ranking rank(const std::vector<Candidate>& candidates);

}  // namespace palpate
